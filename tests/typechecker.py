"""How the annotations of the package are checked while the tests run."""

from beartype import BeartypeConf, beartype

# An int is a float, as type checkers have it.
check = beartype(conf=BeartypeConf(is_pep484_tower=True))
