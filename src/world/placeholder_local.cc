namespace gloam { int placeholder_world; }
