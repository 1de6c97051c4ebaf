"""The motion that is demanded of the wave generator: speed programmes."""
