"""What a fit leaves unexplained, and what the evidence covers."""
