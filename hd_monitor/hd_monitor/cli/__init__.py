"""The hd-monitor command."""
