"""The force of a tire over whole recordings, compiled."""
