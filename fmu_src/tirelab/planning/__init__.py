"""What to record: the shortest set of motions within a rig's limits that tells the effects apart."""
