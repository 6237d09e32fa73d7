"""`python -m stylobate` is `stylobate`."""

from stylobate.cli import main

main()
