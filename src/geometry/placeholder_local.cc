namespace gloam { int placeholder_geometry; }
