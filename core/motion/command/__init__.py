"""What the controller commands in time: ramps, smoothing, leads of elastic joints, samples."""
