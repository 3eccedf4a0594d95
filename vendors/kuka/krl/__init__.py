"""KRL: KUKA's robot language."""
