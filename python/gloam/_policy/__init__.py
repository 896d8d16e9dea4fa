"""Parts of gloam.policy: specification, observation and robot of a network."""
