"""What a motion model states: blend laws, rules, limits, times, where each figure comes from."""
