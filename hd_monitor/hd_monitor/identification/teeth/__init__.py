"""Whether other tooth numbers than those given explain the motion better."""
