"""Packages that only some functions need: imported where they are used."""

from importlib import import_module
from typing import Any

from ._errors import NotBuiltError


def optional(module: str, use: str, package: str, install: str) -> Any:
    """Import a module of a package that cc67 does not depend on.

    Args:
        module: the module, such as "scipy.optimize".
        use: what needs it, as the message begins, such as "a .parquet table".
        package: the name of the package as people write it.
        install: what to give to `pip install`.

    Raises:
        NotBuiltError: the package is not installed.
    """
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        # A package that is there and lacks another one says so itself.
        if error.name is not None and error.name.split(".")[0] != module.split(".")[0]:
            raise
        raise NotBuiltError(f"{use} needs {package}: pip install {install}") from None
