"""Lines at known orders of a joint's rotation, and other ways to look at a vibration along its motion.

The regression on lines, from data to what is known of them::

    joint samples → joint_segment: cut, averaged
    → segment_products (whitened by whitening) or scan (every order of a range): Products
    → pooling: segments added up by direction
    → regression: pool, solve with the orders of line_orders → LineFit: phasors, covariance, chances, evidence

A line's order counts its cycles per output revolution. Reference orders are where there is no line: what a fit finds
there is the noise floor. `order_spectrum` sums a signal up by the angle, so that a line costs no more than a Fourier
transform; `tones` finds what keeps its frequency; `zoom` and `rms_curve` show what the paper shows; `steady` finds
motion at one speed.
"""
