"""The rclpy shell around the core."""
