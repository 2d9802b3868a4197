"""Microsoft's HLSL compiler, as the package compushady-lrtu brings it: a program of its own, since its LLVM and that of
Mesa's drivers do not get on in one process.

    python scripts/dxc.py IN.hlsl OUT -T cs_6_0 -E main -spirv
"""

import ctypes
import importlib.util
import sys
import uuid
from pathlib import Path

# Of dxcapi.h: the compiler, its interface, that of its result, and UTF-8.
COMPILER = "73e22d93-e6ce-47f3-b5bf-f0664f39c1b0"
INTERFACE = "228b4687-5a6a-4730-900c-9702b2203f54"
RESULT = "58346cda-dde7-4497-9461-6f87af5e0659"
UTF8 = 65001


class Source(ctypes.Structure):
    _fields_ = [("text", ctypes.c_char_p), ("size", ctypes.c_size_t), ("encoding", ctypes.c_uint32)]


def guid(text):
    return (ctypes.c_byte * 16).from_buffer_copy(uuid.UUID(text).bytes_le)


def method(this, slot, answer, *kinds):
    """Method number `slot` of a COM object."""
    table = ctypes.cast(this, ctypes.POINTER(ctypes.POINTER(ctypes.c_void_p)))[0]
    return lambda *values: ctypes.CFUNCTYPE(answer, ctypes.c_void_p, *kinds)(table[slot])(this, *values)


def content(blob):
    if not blob:
        return b""
    return ctypes.string_at(method(blob, 3, ctypes.c_void_p)(), method(blob, 4, ctypes.c_size_t)())


def compile_hlsl(text, arguments):
    """Exit status (0: good), messages, and what was made."""
    package = Path(importlib.util.find_spec("compushady").origin).parent
    library = ctypes.CDLL(str(next((package / "backends").glob("libdxcompiler*.so*"))))
    compiler, result = ctypes.c_void_p(), ctypes.c_void_p()
    assert library.DxcCreateInstance(guid(COMPILER), guid(INTERFACE), ctypes.byref(compiler)) == 0
    pointer = ctypes.c_void_p
    call = method(compiler, 3, ctypes.c_int32, pointer, pointer, ctypes.c_uint32, pointer, pointer, pointer)
    source = Source(text, len(text), UTF8)
    words = (ctypes.c_wchar_p * len(arguments))(*arguments)
    assert call(ctypes.byref(source), words, len(arguments), None, guid(RESULT), ctypes.byref(result)) == 0
    status, errors, made = ctypes.c_int32(), pointer(), pointer()
    for slot, out in ((3, status), (4, made), (5, errors)):
        assert method(result, slot, ctypes.c_int32, pointer)(ctypes.byref(out)) == 0
    return status.value, content(errors).rstrip(b"\0").decode(), content(made)


def main():
    source, out, *arguments = sys.argv[1:]
    status, messages, made = compile_hlsl(Path(source).read_bytes(), arguments)
    print(messages, end="", file=sys.stderr)
    if status != 0:
        sys.exit(1)
    Path(out).write_bytes(made)


if __name__ == "__main__":
    main()
