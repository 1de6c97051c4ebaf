"""From records to the stiffness indexes of the two splines, with their covariance and what limits them.

The flow, with a vibration sensor::

    records ─ segment/ ─► Segment: contiguous motion with its vibration, torque and integration grid
            ─ fit/ ─────► Fit: values of the unknowns, their covariance, and why the steps ended
            ─ checks/ ──► what is left at the lines, what the motion covers
            ─ teeth/ ───► whether other tooth numbers explain the motion better
            ─ with_sensor/ ► State, replaced by ``Estimator.update(state, records)``; it holds the result and its limits

Without a sensor ``sensorless/`` pools segments of joint states by direction; both end in an `Identification`, which
holds numbers and codes only. The sentences for people are in :mod:`hd_monitor.diagnosis`.

Vocabulary
----------
line
    Vibration at a fixed order (cycles per output revolution); the k-th pair is k times the two splines' tooth numbers.
segment
    Contiguous motion on a uniform grid, the unit of evidence.
unknowns
    Phasors of the splines' β and transmission errors and of the load, and ln fn, ln ζ, ln(torque / inertia), the lag of
    the clocks, its drift and the inertia's own torque as one vector; each has a prior.
prediction
    The model simulated along the measured motion; its linearisation adds the derivative by every unknown.
information, score
    Curvature and slope of the log likelihood in the unknowns: sums over segments. Faded information stays Gaussian.
wander
    Course of an inertia that moves within a segment, eliminated from what the segment says of the unknowns.
rival
    A second solution that the data do not exclude yet; its distance widens the intervals.
noise floor
    Power of the residual over frequency, which weights every row of a fit.
residual, overdispersion
    What is left at the lines' own orders, and by how much segments contradict each other: both widen the intervals.
reference orders
    Orders beside a line at which nothing turns: what a fit finds there is the noise floor of that line.
multistart
    The fit from several starts on the newest segments, since the cost has local minima in load, delay and resonance.
limitation
    A reason to doubt a result or not to name a part on it: a code and its numbers.
"""
