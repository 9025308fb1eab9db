// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "fuzzing.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size)
{
	std::istringstream in = fuzzing::streamOf(data, size);
	try {
		fuzzing::workOn(fuzzing::readCg(in).skeleton);
	}
	catch (const fuzzing::FormatError& error) {
		fuzzing::require(error.line() > 0, "the error names a line");
	}
	return 0;
}
