"""`python -m gloam ARG…`: the program."""

from gloam.program import main

main()
