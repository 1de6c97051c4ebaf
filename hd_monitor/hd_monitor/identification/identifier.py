"""Identification of the stiffness indexes from the vibration and the motion it belongs to."""

import math
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from ..acquisition.record import Record
from ..settings import JointSettings
from .gauss_newton import Fit, Prior, Problem
from .indexes import stiffness_indexes
from .linearisation import Predictor
from .noise_floor import NoiseFloor, Spectral
from .result import Identification
from .stretch import Stretch, StretchBuilder
from .unknowns import Unknowns

FloatArray = npt.NDArray[np.float64]

LOAD_ORDERS = (1, 2)
SHORTEST = 0.25  # s
LONGEST_STRETCH = 4.0  # s
WINDOW = 16.0  # s


class Identifier:
    """Identifies one joint's reducer from accelerations, a record at a time.

    Parameters
    ----------
    settings : JointSettings
    """

    def __init__(self, settings: JointSettings) -> None:
        self._settings = settings
        self._reducer = settings.reducer
        self._dynamics = settings.dynamics
        self._minimum_speed = settings["analysis.minimum_speed"] * math.tau / 60.0 / self._reducer.reduction
        self._unknowns = Unknowns(harmonics=settings["analysis.harmonics"], load_orders=LOAD_ORDERS)
        u = self._unknowns
        std = np.full(u.size, 0.3)
        std[u.load] = 2.0
        std[u.frequency] = 0.03
        self._prior = Prior.gaussian(u.zero(), std)
        self._active = np.ones(u.size, dtype=np.bool_)
        self._active[[u.frequency, u.damping]] = False
        self._values = u.zero()
        self._pending: list[Record] = []
        self._window: list[tuple[Stretch, Spectral]] = []
        self._floor: NoiseFloor | None = None
        self._seconds = 0.0
        self._samples = 0
        self._lowest, self._highest = math.inf, -math.inf
        self._estimate: Identification | None = None

    def add(self, record: Record) -> None:
        """Take the next record."""
        if not record.continues:
            self._flush()
        if len(record) < 16 or float(np.abs(record.speed).max()) < self._minimum_speed:
            self._flush()
            return
        self._pending.append(record)
        duration = sum(len(r) * r.period for r in self._pending)
        if duration >= min(LONGEST_STRETCH, max(0.9, 0.25 * self._seconds)):
            self._flush()

    def estimate(self) -> Identification | None:
        """Return the newest estimate; None as long as there was not enough motion."""
        return self._estimate

    def _flush(self) -> None:
        records, self._pending = self._pending, []
        if not records or sum(len(r) * r.period for r in records) < SHORTEST:
            return
        known = all(np.isfinite(r.torque).all() for r in records)
        source = self._settings["load.source"]
        measured = known and source in ("auto", "effort")
        builder = StretchBuilder(
            reducer=self._reducer,
            harmonics=self._unknowns.harmonics,
            load_orders=LOAD_ORDERS,
            natural_frequency=self._dynamics.natural_frequency,
            torque=None if measured else self._settings["load.torque"],
            inertial=self._settings["input.source"] == "imu",
        )
        stretch = builder.build(records)
        if int(stretch.used.sum()) < 100:
            return
        self._window.append((stretch, Spectral(stretch)))
        self._seconds += stretch.duration
        self._samples += int(stretch.used.sum())
        self._lowest = min(self._lowest, float(stretch.angle.min()))
        self._highest = max(self._highest, float(stretch.angle.max()))
        self._refit()

    def _refit(self) -> None:
        u = self._unknowns
        torque = np.concatenate([s.at_steps.torque for s, _ in self._window])
        reference = float(np.sqrt(np.mean(torque**2))) or 1.0
        predictor = Predictor(unknowns=u, given=self._dynamics, reference_torque=reference)
        first = self._floor is None
        floor = self._floor or self._flat()
        problem = Problem(
            stretches=[s for s, _ in self._window],
            spectrals=[f for _, f in self._window],
            predictor=predictor,
            prior=self._prior,
            floor=floor,
            active=self._active,
        )
        if first:
            fits = []
            for start in self._starts():
                held = replace(problem, active=self._active & ~np.isin(np.arange(u.size), np.r_[u.load]))
                fit = problem.solve(held.solve(start, rounds=1).values, rounds=8)
                problem = replace(problem, floor=self._floor_of(fit, flat=True))
                fit = problem.solve(fit.values, rounds=8)
                fits.append((fit.equations.cost * problem.floor.mean, fit))
            fit = min(fits, key=lambda item: item[0])[1]
        else:
            fit = problem.solve(self._values, rounds=4)
        problem = replace(problem, floor=self._floor_of(fit))
        fit = problem.solve(fit.values, rounds=4)
        self._values = fit.values
        self._floor = self._floor_of(fit)
        self._conclude(fit, predictor)
        while sum(s.duration for s, _ in self._window) > WINDOW:
            self._window.pop(0)
            self._prior = self._prior.plus(fit.evidence[0].equations, fit.values)

    def _starts(self) -> list[FloatArray]:
        starts = [self._unknowns.zero()]
        for phase in (0.0, 0.5, 1.0, 1.5):
            start = self._unknowns.zero()
            load = 1.5 * np.exp(1j * np.pi * phase)
            start[self._unknowns.load] = [0.0, load.real, 0.0, load.imag]
            starts.append(start)
        return starts

    def _flat(self) -> NoiseFloor:
        floor = NoiseFloor.empty(self._window[0][0].period)
        power = 0.0
        for stretch, spectral in self._window:
            power += float(np.mean(spectral(stretch.acceleration[:, None]) ** 2)) / spectral.fill
        return NoiseFloor(
            edges=floor.edges,
            power=np.full(floor.power.size, max(power / len(self._window), 1e-12) * 1e3),
            freedom=np.full(floor.power.size, 1e3),
        )

    def _floor_of(self, fit: Fit, *, flat: bool = False) -> NoiseFloor:
        floor = NoiseFloor.empty(self._window[0][0].period)
        share = self._unknowns.size / len(fit.evidence)
        for item in fit.evidence:
            floor = floor.updated(item.spectral, item.residual, unknowns=share)
        if flat:
            return NoiseFloor(
                edges=floor.edges,
                power=np.full(floor.power.size, floor.mean * 1e3),
                freedom=np.full(floor.power.size, 1e3),
            )
        return floor

    def _conclude(self, fit: Fit, predictor: Predictor) -> None:
        u = self._unknowns
        total = fit.equations.information + self._prior.information
        covariance = np.zeros((u.size, u.size))
        place = np.ix_(self._active, self._active)
        covariance[place] = np.linalg.inv(total[place])
        result = stiffness_indexes(u, fit.values, covariance)
        residual = sum(float(i.linearisation.residual @ i.linearisation.residual) for i in fit.evidence)
        explained = sum(
            float(np.sum((i.linearisation.predicted - i.linearisation.predicted.mean()) ** 2)) for i in fit.evidence
        )
        self._estimate = Identification(
            circular_spline=u.phasors(fit.values, u.circular_spline),
            flexspline=u.phasors(fit.values, u.flexspline),
            index=result.index,
            index_std=result.std,
            index_correlation=result.correlation,
            travel=self._highest - self._lowest,
            samples=self._samples,
            signal_to_noise=10.0 * math.log10(max(explained, 1e-300) / max(residual, 1e-300)),
            misfit=fit.equations.cost / fit.equations.freedom,
            natural_frequency=self._dynamics.natural_frequency,
            damping_ratio=self._dynamics.damping_ratio,
        )
