"""Whether VTK can draw here. Where it cannot it ends the process, so it must not be tried."""

import ctypes
import os
import sys
from functools import cache

from surfmesh.errors import needs

SURFACELESS = 0x31DD  # EGL_PLATFORM_SURFACELESS_MESA
FIRST_WITH_EGL = (9, 4)  # versions of VTK; older wheels draw on an X display alone


@cache
def can_draw() -> bool:
    """True with a display, or with a VTK that needs none and an EGL library that starts so."""
    if sys.platform != "linux" or os.environ.get("DISPLAY"):
        return True
    if _vtk_version() < FIRST_WITH_EGL:
        return False
    try:
        egl = ctypes.CDLL("libEGL.so.1")
        egl.eglGetPlatformDisplay.restype = ctypes.c_void_p
        egl.eglGetPlatformDisplay.argtypes = [ctypes.c_uint, ctypes.c_void_p, ctypes.c_void_p]
        egl.eglGetDisplay.restype = ctypes.c_void_p
        egl.eglGetDisplay.argtypes = [ctypes.c_void_p]
        egl.eglInitialize.argtypes = [ctypes.c_void_p] * 3
    except (OSError, AttributeError):
        return False
    displays = (egl.eglGetPlatformDisplay(SURFACELESS, None, None), egl.eglGetDisplay(None))
    return any(display and egl.eglInitialize(display, None, None) for display in displays)


def _vtk_version() -> tuple[int, int]:
    with needs("view", "a picture"):
        from vtkmodules.vtkCommonCore import vtkVersion

    version = vtkVersion()
    return version.GetVTKMajorVersion(), version.GetVTKMinorVersion()
