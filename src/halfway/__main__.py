"""The ``halfway`` command, and ``python -m halfway``: Ctrl-C at any moment, even while it starts, is one line and exit 130."""

import signal
import sys


def main() -> None:
    """Run the command line."""
    try:
        try:
            from .cli import main as run

            run()
        finally:
            # All is said and written: what is left is the interpreter's own end, whose handlers are not to be heard of.
            signal.signal(signal.SIGINT, signal.SIG_DFL)
    except KeyboardInterrupt:
        print(
            "halfway: interrupted; what was finished is kept, and the same command goes on from there.",
            file=sys.stderr,
        )
        sys.exit(130)


if __name__ == "__main__":
    main()
