namespace gloam { int placeholder_sim; }
