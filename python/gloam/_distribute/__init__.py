"""Parts of gloam.distribute: the list of a folder, its tasks, the cluster."""
