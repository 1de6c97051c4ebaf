"""Lines at known orders of a joint's rotation: segments, whitening, regression, spectra, RMS by speed."""
