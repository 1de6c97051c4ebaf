"""From records to the stiffness indexes of the two splines, with their covariance."""
