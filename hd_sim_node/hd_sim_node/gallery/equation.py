"""The section of the page that states what is simulated: the equation of motion, law by law."""

from ..drive.defects import FAULTY, HEALTHY
from ..drive.elasticity import ROUNDING
from ..motion.robot import GRIP_TIME

EQUATION = f"""\
## The equation

    J θ'' + C (θ' + e') + K G(θ + e) + T z = M − F(q' + θ')

θ is the torsional vibration at the output, q the output angle that the programme demands, e the transmission error and
θ + e the twist of the flexspline. z1, z2 and i are the orders of the circular spline, of the flexspline and of the wave
generator: cycles per output revolution, by default 160, 162 and 80. The drive starts at rest, wound up by the torque
there. Angles are in radians here; names are parameters, those of the group in brackets without it.

- **Inertia** J = J0 (1 + s + `payload` p), J0 being `dynamics.inertia` (`inertia.*`). s is a sine wave between `lowest`
  and `highest` that starts at 0, rising. p is the part of the payload that is carried: it goes from 0 to 1 and back as
  half a cosine wave, in the {GRIP_TIME:g} s in which the gripper closes or opens.
- **Damping** C = 2 ζ ω J0 with ω = 2π fn (`dynamics.*`).
- **Stiffness** K = J0 ω² (1 + Σ βk cos(k z2 q + phase) + Σ βk cos(k z1 q + phase)), with the β of the flexspline,
  then of the circular spline. A sound spline has β = {list(HEALTHY.beta)} with the phases {list(HEALTHY.phase)},
  a bad one {list(FAULTY.beta)} with {list(FAULTY.phase)}; `defect: custom` takes the ones given.
- **Transmission error** e = Σ ½ size cos(k z2 q + phase), and the same with z1 and with i (`*.transmission_error`).
- **Steps of stiffness** G(τ) = k1 τ + (k2 − k1) B(τ, τ1) + (k3 − k2) B(τ, τ2) of the twist τ, with the `ratios` k
  (`elasticity.*`). The corners lie at τ1 = T1/(k1 J0 ω²) and τ2 = τ1 + (T2 − T1)/(k2 J0 ω²), with ω at the start, and
  are rounded: B(τ, a) = r(τ − a) − r(−τ − a), where r(x) = ½ (x + √(x² + ({ROUNDING:g} a)²)).
- **Hysteresis** T z by Dahl's law, dz/dτ = (1 − z sign τ')/x, with z = 0 at the start (`hysteresis.*`: `torque` is
  T and `twist` is x).
- **Friction** F(v) = (`coulomb` + `stribeck`/(1 + (v/`stribeck_velocity`)²)) v/√(v² + `creep_velocity`²) + `viscous` v
  (`friction.*`). It acts on the output; the Stribeck curve is Hess and Soom's.
- **Torque** M is the sum of `mean`, (`gravity` + `payload` p) cos(q − `gravity_angle`), `ripple` cos(n i q +
  `ripple_phase`) for each n in `ripple_orders`, `drive_fluctuation` cos(2 i q + `drive_phase`) and `load_fluctuation`
  cos(`load_order` q + `load_phase`) (`torque.*`); with `rigid_body` also −J q''.
- **Warming up**: after t seconds the drive is w = 1 − exp(−t/`time`) warm, and fn, ζ and F have changed by w times the
  fraction given (`drift.*`).
- **Growth**: β and e of a spline grow linearly to the factor given, over `length` from `start` (`growth.*`).
"""
"""In Markdown."""
