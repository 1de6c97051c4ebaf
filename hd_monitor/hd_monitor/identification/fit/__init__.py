"""From segments to values: the table of unknowns, the prediction, its linearisation and the Gauss-Newton fit."""
