namespace gloam { int placeholder_control; }
