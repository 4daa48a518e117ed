"""The date that files carry when one is asked for; without, files do not know when they were made.

SOURCE_DATE_EPOCH: seconds since 1970, see https://reproducible-builds.org/specs/source-date-epoch.
"""

import os
from datetime import UTC, datetime

from surfmesh.errors import FileFormatError

VARIABLE = "SOURCE_DATE_EPOCH"


def asked_date() -> datetime | None:
    """What the environment variable ``SOURCE_DATE_EPOCH`` says, in UTC; None when it is not set.

    Raises ``FileFormatError`` when it is no such date.
    """
    said = os.environ.get(VARIABLE, "").strip()
    if not said:
        return None
    if said.isascii() and said.isdigit() and len(said) <= 12:  # datetime ends with the year 9999
        try:
            return datetime.fromtimestamp(int(said), UTC)
        except (ValueError, OverflowError, OSError):
            pass
    raise FileFormatError(f"{VARIABLE} is {said[:40]!r}: whole seconds since 1970 are expected")
