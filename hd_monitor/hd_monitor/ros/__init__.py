"""The rclpy shell: parameters, drained subscriptions, publishers and the node around the core."""
