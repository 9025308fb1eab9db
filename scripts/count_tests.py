#!/usr/bin/env python3
# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sums up the JUnit reports of a test run; fails if anything failed."""

import argparse
import sys
import xml.etree.ElementTree as ElementTree
from collections import Counter
from pathlib import Path


def outcome(case: ElementTree.Element) -> str:
    if case.find("failure") is not None or case.find("error") is not None:
        return "failed"
    if case.find("skipped") is not None or case.get("status") in ("notrun", "disabled"):
        return "skipped"
    return "passed"


def line(title: str, counts: Counter[str]) -> str:
    return f"{title}: " + ", ".join(f"{counts[kind]} {kind}" for kind in ("passed", "failed", "skipped"))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("ctest", type=Path, help="report of ctest")
    parser.add_argument("pytest", type=Path, nargs="*", help="reports of pytest")
    options = parser.parse_args()

    unit: Counter[str] = Counter()
    broken = 0  # pytest runs that ended without a report of their own
    reports = {path.stem: path for path in options.pytest if path.is_file()}
    for case in ElementTree.parse(options.ctest).iter("testcase"):
        if case.get("name", "").startswith("pytest."):
            broken += outcome(case) == "failed" and case.get("name", "")[len("pytest."):] not in reports
        else:
            unit[outcome(case)] += 1
    python: Counter[str] = Counter(failed=broken)
    for path in reports.values():
        for case in ElementTree.parse(path).iter("testcase"):
            result = outcome(case)
            python[result] += 1
            if result == "skipped":
                reason = case.find("skipped")
                print(f"skipped: {case.get('name')}: {reason.get('message') if reason is not None else ''}")
    print(line("GoogleTest", unit))
    print(line("pytest", python))
    return 1 if unit["failed"] or python["failed"] else 0


if __name__ == "__main__":
    sys.exit(main())
