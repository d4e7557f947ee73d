#!/bin/bash
# Edits, other looks and lenses from Python, with the module of a build under the address and undefined behaviour
# sanitizers: tests/sanitize/run.sh PYTHON BUILD
set -euo pipefail

root="$(cd "$(dirname "$0")/../.." && pwd)"
python="$(cd "$(dirname "$1")" && pwd)/$(basename "$1")"
build="$(cd "$2" && pwd)"
package="$build/package"

mkdir -p "$package/decalgl"
ln -sf "$root"/python/decalgl/* "$build"/python/_core*.so "$package/decalgl/"
# An editable install would be found first.
cat > "$package/no_install.py" <<PYTHON
import sys

sys.meta_path[:] = [finder for finder in sys.meta_path if "editable" not in type(finder).__module__]

import decalgl._core

assert decalgl._core.__file__.startswith("$package/"), decalgl._core.__file__
PYTHON

cd "$root"
# Python keeps memory until it ends, which is no leak of ours.
exec env LD_PRELOAD="$(gcc -print-file-name=libasan.so) $(gcc -print-file-name=libubsan.so)" \
    ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=print_stacktrace=1 PYTHONPATH="$package" \
    "$python" -m pytest -p no_install -p no:cacheprovider -q \
    tests/python/{edit,restyle,lens}_test.py -k "(bvh or Bvh or lens) and not coverage" "${@:3}"
