"""Arguments that are checked before C++ sees them, in the words of the program's errors."""
import operator

from .errors import BadInput

MOST_CASES = 2**32 - 1
MOST_SEED = 2**64 - 1
MOST_THREADS = 1024


def refuse(message, allowed):
    """BadInput without a place in a file."""
    return BadInput([("", 0, 0, "", message, allowed)])


def whole(name, value, least=0, most=MOST_SEED):
    """A whole number in a range; None stays None."""
    if value is None:
        return None
    try:
        number = operator.index(value)
    except TypeError:
        raise refuse(f"{name}: {value!r} is not a whole number", f"a whole number from {least} to {most}") from None
    if not least <= number <= most:
        raise refuse(f"{name}: {number} is out of range", f"a whole number from {least} to {most}")
    return number
