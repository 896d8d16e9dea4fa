namespace gloam {}
