namespace gloam { int placeholder_scene; }
