"""What is measured of the drive, and how badly: accelerometer, IMU, joint encoder."""
