"""Runs a batch in a process of its own for each line on stdin, which names the folder; prints the process's id.

The next line, whatever it says, asks for its end. What takes a second to load is loaded once, so that many runs can be killed in
a few seconds. The library is a stored one, whose path is the first argument.
"""

import os
import sys
from pathlib import Path

from halfway import LinearSpace, Route, open_library
from halfway.export import write_route
from halfway.recipes import mix

N = 40


def main() -> None:
    library = open_library(sys.argv[1])
    route = Route.through(LinearSpace.of(library), library.names[:3])
    mix(library, route.recipe(0.1))  # compiles
    print("ready", flush=True)
    for line in sys.stdin:
        child = os.fork()
        if not child:
            write_route(Path(line.strip()), route, route.steps(N), library, format="merl")
            os._exit(0)
        print(child, flush=True)
        sys.stdin.readline()
        os.waitpid(child, 0)
        print("ended", flush=True)


if __name__ == "__main__":
    main()
