namespace gloam {
void world_local_placeholder() {}
}  // namespace gloam
