"""What a fit leaves unexplained, what the evidence covers, and what limits it: codes and numbers, no prose."""
