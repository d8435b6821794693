#!/usr/bin/env python3
"""Enforces which folder may include which (docs/decisions/0001-folders-and-include-rule.md).

Usage: include_rule.py ROOT | include_rule.py --self-test
Prints "file:line: what is wrong; what is allowed" for every violation; exit code 1 if there is any.
"""

import re
import sys
import tempfile
from pathlib import Path

# Folder -> folders of the project it may include; its own is always allowed. "wire" stands for headers named
# *_wire.hpp: constants of a protocol, the only thing an emulator shares with the driver that speaks to it.
ALLOWED = {
    "hal": set(),
    "hal/linux": {"hal"},
    "reader": {"hal"},
    "servo": {"hal"},
    "flight/mavlink": {"hal", "flight"},
    "flight": {"hal", "reader", "servo", "flight/mavlink"},
    "mocks": {"hal", "wire"},
    "boards": {"hal", "hal/linux", "reader", "servo", "flight/mavlink", "flight", "mocks"},
    "tools": {"hal", "reader", "servo", "flight/mavlink", "flight", "boards"},
    "tests": {"hal", "hal/linux", "reader", "servo", "flight/mavlink", "flight", "mocks", "boards", "tools", "tests"},
}
FOLDERS = sorted(ALLOWED, key=len, reverse=True)

# Headers of vendor libraries: only a .cpp may include them. expected is part of every interface; tests and the
# program, which nobody includes, are free.
VENDOR = re.compile(
    r"^(fmt/|spdlog/|pugixml|toml\+\+/|toml\.hpp|CLI/|CLI11|nlohmann/|curl/|sqlite3|openssl/|gpiod|libusb|hidapi|"
    r"modbus|systemd/|hwy/|gtest/|gmock/|rapidcheck|benchmark/)"
)
# Headers of the operating system: below hal/linux, boards and tools nothing touches the machine.
SYSTEM = re.compile(
    r"^(unistd\.h|fcntl\.h|poll\.h|pthread\.h|signal\.h|csignal|semaphore\.h|termios\.h|netdb\.h|dirent\.h|ifaddrs\.h|"
    r"(sys|linux|arpa|net|netinet|asm)/.*|thread|mutex|condition_variable|future|shared_mutex|stop_token|semaphore|"
    r"latch|barrier)$"
)
MAY_TOUCH_SYSTEM = {"hal/linux", "boards", "tools", "tests"}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def folder_of(path):
    """The longest listed folder that holds path, or None."""
    return next((folder for folder in FOLDERS if path.startswith(folder + "/")), None)


def complaint(source, bracket, target):
    """What is wrong with source including target, or None."""
    folder = folder_of(source)
    if bracket == "<":
        if source.endswith(".hpp") and folder not in ("tests", "tools") and VENDOR.match(target):
            return f"<{target}>: a vendor header in a header; allowed: std and tl/expected, vendors in a .cpp only"
        if SYSTEM.match(target) and folder not in MAY_TOUCH_SYSTEM:
            return (f"<{target}>: threads and the operating system in {folder}/; "
                    f"allowed in: {', '.join(sorted(MAY_TOUCH_SYSTEM))}")
        return None
    goal = folder_of(target)
    if goal is None:
        return f'"{target}": not a path from the root; allowed: "<folder>/<file>.hpp"'
    if goal == folder:
        return None
    allowed = ALLOWED[folder]
    if goal in allowed:
        return None
    if "wire" in allowed and target.endswith("_wire.hpp"):
        return None
    names = ", ".join(sorted(allowed - {"wire"})) or "no other folder"
    wire = " and *_wire.hpp constants" if "wire" in allowed else ""
    return f'"{target}": {folder}/ includes {goal}/; allowed: {names}{wire}'


def violations(root):
    for folder in sorted({name.split("/")[0] for name in ALLOWED}):
        for path in sorted((root / folder).rglob("*")):
            if path.suffix not in (".hpp", ".cpp") or "node_modules" in path.parts:
                continue
            source = path.relative_to(root).as_posix()
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
                found = INCLUDE.match(line)
                why = complaint(source, *found.groups()) if found else None
                if why:
                    yield f"{source}:{number}: {why}"


def self_test():
    good = {
        "hal/a.hpp": "#include <vector>\n#include <tl/expected.hpp>\n",
        "hal/a.cpp": '#include "hal/a.hpp"\n#include <fmt/format.h>\n',
        "hal/linux/b.cpp": '#include <sys/socket.h>\n#include "hal/a.hpp"\n',
        "reader/x_wire.hpp": '#include "hal/a.hpp"\n',
        "mocks/sim_x.cpp": '#include "reader/x_wire.hpp"\n',
        "flight/f.cpp": '#include "flight/mavlink/m.hpp"\n#include "reader/x_wire.hpp"\n',
        "boards/c.cpp": '#include "mocks/sim_x.hpp"\n#include "hal/linux/b.hpp"\n',
        "tests/hal/t.cpp": '#include "tests/hal/contract.hpp"\n#include <thread>\n',
    }
    bad = {
        "hal/up.cpp": '#include "reader/x.hpp"\n',
        "hal/vendor.hpp": "#include <fmt/format.h>\n",
        "hal/linux/up.cpp": '#include "flight/f.hpp"\n',
        "reader/side.cpp": '#include "flight/f.hpp"\n',
        "reader/backend.cpp": '#include "hal/linux/b.hpp"\n',
        "reader/double.cpp": '#include "mocks/sim_x.hpp"\n',
        "flight/up.cpp": '#include "boards/c.hpp"\n',
        "flight/thread.cpp": "#include <thread>\n",
        "mocks/codec.cpp": '#include "flight/mavlink/codec.hpp"\n',
        "mocks/driver.cpp": '#include "reader/advannet_reader.hpp"\n',
        "tools/double.cpp": '#include "mocks/sim_x.hpp"\n',
        "tools/backend.cpp": '#include "hal/linux/b.hpp"\n',
        "boards/tests.cpp": '#include "tests/hal/contract.hpp"\n',
        "reader/relative.cpp": '#  include "x.hpp"\n',
    }
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for name, text in {**good, **bad}.items():
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text("// first line\n" + text, encoding="utf-8")
        found = list(violations(root))
    caught = {line.split(":")[0] for line in found}
    missed = sorted(set(bad) - caught)
    wrongly = sorted(caught - set(bad))
    off = [line for line in found if ":2: " not in line or "allowed" not in line]
    for name in missed:
        print(f"self-test: not caught: {name}")
    for name in wrongly:
        print(f"self-test: wrongly caught: {name}")
    for line in off:
        print(f"self-test: wrong line number or no rule: {line}")
    return 1 if missed or wrongly or off else 0


def main(arguments):
    if arguments == ["--self-test"]:
        return self_test()
    if len(arguments) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    found = list(violations(Path(arguments[0])))
    print("\n".join(found) if found else "every include follows the rule")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
