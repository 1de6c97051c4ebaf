"""What the sensor does to the spectrum: the same drive measured less well."""

from .effects import LENGTH, SETTLING, SWINGING, Effect

_SLOW = {"sensor.rate": 141.0}  # folds the pair k = 2 into the window, upside down

SENSORS = (
    Effect(
        "Low rate without a filter",
        _SLOW,
        "The pair k = 2 lies above half the rate and folds down around k = 1, in reverse order: lines that no part "
        "makes, one of them higher than the circular spline's.",
    ),
    Effect(
        "Low rate behind an anti-aliasing filter",
        {"sensor.bandwidth": 60.0, "sensor.filter_order": 8},
        "The folded lines sink by a factor of about forty; those of k = 1 stay as they were.",
        _SLOW,
    ),
    Effect(
        "Bandwidth below the lines",
        {"sensor.bandwidth": 30.0},
        "Both lines sink alike: which is the higher one is still right, but the indexes come out too small.",
    ),
    Effect(
        "Gain and sign",
        {"sensor.gain": -0.5},
        "Both lines are halved. The wrong sign turns their phases by half a turn, which no amplitude shows.",
    ),
    Effect(
        "IMU with cross-axis sensitivity",
        {"publish_imu": True, "sensor.cross_axis": 0.05},
        "Nothing: gravity, 18 rad/s² at this radius, and what leaks across turn once per output revolution, far below.",
        SWINGING,
    ),
    Effect(
        "Fast clock",
        {"sensor.clock_drift": 2000.0},
        "The lines appear 0.2 % too low, a sixth of their spacing. At 100 ppm that is a quarter of a bin, 0.005 Hz.",
    ),
    Effect(
        "Clipping",
        {"sensor.full_scale": 6.0},
        "Both lines shrink, and the one a spacing above the flexspline's grows, which coupling or a load does as well.",
    ),
    Effect(
        "Spikes",
        {"sensor.spike_rate": 2.0},
        "The floor rises at all frequencies alike; the lines stand where they stood.",
    ),
    Effect(
        "Dying sensor",
        {"sensor.fault": "dying", "sensor.fault_after": SETTLING, "sensor.fault_time": LENGTH},
        "The lines shrink to half, on a broader foot, as if the drive recovered; the rising floor betrays the sensor.",
    ),
)
"""In the order of the picture."""
