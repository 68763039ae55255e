#!/usr/bin/env python3
"""Turns a pFUnit test file (.pf) into plain Fortran, for machines without pFUnit.

    pf2f90.py TEST.pf MODULE.f90 MAIN.f90

MODULE.f90 is the test module, line for line, with each @assert... made a call of the module `funit` beside this file;
MAIN.f90 is a program that runs every @test of it. The subset of pFUnit that is understood:
    @test            alone on a line, before a subroutine without arguments of a module
    @assertXxx(...)  on one line without a comment, for the assertions below
Anything else that starts with @ is an error, so that nothing is left untested in silence.
"""

import re
import sys

ASSERTIONS = {
    name.lower(): name
    for name in (
        "assertEqual", "assertNotEqual", "assertTrue", "assertFalse", "assertLessThan", "assertLessThanOrEqual",
        "assertGreaterThan", "assertGreaterThanOrEqual", "assertRelativelyEqual", "assertIsNan", "assertIsFinite",
    )
}
DIRECTIVE = re.compile(r"^(\s*)@(\w+)\s*(.*?)\s*$")
SUBROUTINE = re.compile(r"^\s*(?:recursive\s+)?subroutine\s+(\w+)\s*(?:\(([^)]*)\))?\s*(?:!.*)?$", re.IGNORECASE)
MODULE = re.compile(r"^\s*module\s+(\w+)\s*(?:!.*)?$", re.IGNORECASE)


class Mistake(Exception):
    pass


def quoted(string):
    """A Fortran character literal."""
    return "'" + string.replace("'", "''") + "'"


def argument_list(rest):
    """What stands between the parentheses of an assertion, or None if they do not close at the end of the line."""
    if not rest.startswith("("):
        return None
    depth, quote = 0, ""
    for position, character in enumerate(rest):
        if quote:
            if character == quote:
                quote = ""
        elif character in "'\"":
            quote = character
        elif character == "(":
            depth += 1
        elif character == ")":
            depth -= 1
            if depth == 0:
                return rest[1:position].strip() if position == len(rest) - 1 else None
    return None


def translate(lines, path):
    """The translated lines, the name of the module, and the names of its tests."""
    output, tests, module, waiting = [], [], None, 0
    for number, line in enumerate(lines, start=1):
        directive = DIRECTIVE.match(line)
        if directive:
            indent, word, rest = directive.groups()
            if waiting:
                raise Mistake(f"{path}:{waiting}: @test is not followed by a subroutine")
            if word.lower() == "test":
                if rest:
                    raise Mistake(f"{path}:{number}: @test stands alone on its line")
                waiting = number
                output.append(indent + "! test")
            elif word.lower() in ASSERTIONS:
                arguments = argument_list(rest)
                if not arguments:
                    raise Mistake(f"{path}:{number}: @{word} needs its arguments in parentheses on one line, and no comment")
                name = ASSERTIONS[word.lower()]
                output.append(f"{indent}call {name}({arguments}, line={number}); if (test_failed()) return")
            else:
                raise Mistake(f"{path}:{number}: @{word} is not known; known are @test, "
                              + ", ".join("@" + name for name in sorted(ASSERTIONS.values())))
            continue
        if waiting and line.strip() and not line.lstrip().startswith("!"):
            subroutine = SUBROUTINE.match(line)
            if not subroutine:
                raise Mistake(f"{path}:{waiting}: @test is not followed by a subroutine")
            if (subroutine.group(2) or "").strip():
                raise Mistake(f"{path}:{number}: the test {subroutine.group(1)} has arguments")
            if subroutine.group(1).lower() in (test.lower() for test in tests):
                raise Mistake(f"{path}:{number}: the test {subroutine.group(1)} is there twice")
            tests.append(subroutine.group(1))
            waiting = 0
        elif module is None and MODULE.match(line):
            module = MODULE.match(line).group(1)
        output.append(line)
    if waiting:
        raise Mistake(f"{path}:{waiting}: @test is not followed by a subroutine")
    if module is None:
        raise Mistake(f"{path}: there is no module")
    if not tests:
        raise Mistake(f"{path}: there is no @test")
    return output, module, tests


def main_program(module, tests, path):
    lines = [f"program run_{module}", "  use funit, only: start_tests, begin_test, end_test, finish_tests"]
    lines += [f"  use {module}, only: {test}" for test in tests]
    lines += ["  implicit none", f"  call start_tests({quoted(module)}, &", f"                   {quoted(path)})"]
    for test in tests:
        lines += [f"  call begin_test({quoted(test)})", f"  call {test}()", "  call end_test()"]
    return lines + ["  call finish_tests()", f"end program run_{module}"]


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    source, module_file, main_file = sys.argv[1:]
    try:
        with open(source, encoding="utf-8") as file:
            lines, module, tests = translate(file.read().splitlines(), source)
    except Mistake as mistake:
        sys.exit(f"error: {mistake}")
    # The line marker makes the compiler report the lines of the .pf file.
    for name, text in ((module_file, [f'# 1 "{source}"'] + lines), (main_file, main_program(module, tests, source))):
        with open(name, "w", encoding="utf-8") as file:
            file.write("\n".join(text) + "\n")


if __name__ == "__main__":
    main()
