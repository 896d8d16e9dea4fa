"""Parts of gloam.policy: what a network was trained with, its observation, its robot."""
