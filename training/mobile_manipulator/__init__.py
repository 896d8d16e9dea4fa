"""Velocity tracking of the mobile manipulator in assets/robots/mobile_manipulator while its arm moves."""
