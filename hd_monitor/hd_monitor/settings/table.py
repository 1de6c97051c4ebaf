"""The table of all parameters: what a joint has, what the node has, and what any ROS node has."""

from ..parameter import Parameter, choice, number, parameters_of, plain, table
from ..reducer import Mount
from .groups import AnalysisSettings, DiagnosisSettings, HistorySettings, InputSettings, LoadSettings

PARAMETERS = (
    *table(
        "reducer.",
        flexspline_teeth=number(160, "", 1, 10_000, "teeth of the flexspline, z1"),
        circular_spline_teeth=number(162, "", 1, 10_000, "teeth of the circular spline, z2 (usually z1 + 2)"),
        mount=choice("circular_spline_fixed", Mount, "the stationary spline"),
        serial=plain("", "serial number of the reducer, shown as hardware_id"),
        transmission_error=number(
            1.0,
            "arcmin",
            0.0,
            60.0,
            "transmission error, peak to peak, that a sound unit may have: the catalogue's positional accuracy (1.0 "
            "for size 20 and above); it is then estimated beside the stiffness indexes, which it resembles; 0: there "
            "is none, as in the paper",
        ),
    ),
    *table(
        "dynamics.",
        natural_frequency=number(55.0, "Hz", 0.5, 2000.0, "torsional natural frequency of the joint with its load"),
        damping_ratio=number(0.023, "", 1e-4, 0.7, "fraction of critical damping"),
        inertia=number(0.29, "kg·m²", 1e-6, 1e6, "inertia that the reducer drives, seen at its output"),
        natural_frequency_uncertainty=number(
            0.1,
            "",
            0.0,
            0.2,
            "how sure you are of the natural frequency: its standard deviation as a part of it; 0: known exactly, "
            "never refined",
        ),
        damping_uncertainty=number(
            0.5,
            "",
            0.0,
            1.0,
            "the same of the damping ratio; 0.5: it may well be 1.6 times larger or smaller",
        ),
        inertia_uncertainty=number(
            0.2, "", 0.0, 1.0, "the same of the inertia, and so of the scale of every stiffness index"
        ),
        hardening_uncertainty=number(
            0.2,
            "",
            0.0,
            1.0,
            "how much softer or stiffer the reducer may be at other torques than the usual one, as catalogues state by "
            "K1, K2 and K3: a standard deviation, as a part of the stiffness; 0: the same at every torque",
        ),
    ),
    *parameters_of(InputSettings, "input."),
    *parameters_of(LoadSettings, "load."),
    *parameters_of(AnalysisSettings, "analysis."),
    *parameters_of(DiagnosisSettings, "diagnosis."),
    *parameters_of(HistorySettings, "history."),
)
"""Parameters of a joint."""

JOINTS = Parameter(
    name="joints",
    default="[joint]",
    description="names of the joints watched; one alone called `joint` takes the only one in joint_states; with "
    "several, each has its topics below its name and may override any parameter there (`JOINT.reducer.serial`)",
)
NODE_PARAMETERS = table(autostart=plain(True, "come up configured and active, without a lifecycle manager"))
"""Parameters of the node as a whole, besides `joints`: they say nothing about any joint."""

ROS_PARAMETERS = ("use_sim_time", "start_type_description_service")
"""Parameters that every ROS node has of its own."""
