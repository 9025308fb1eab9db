// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "fuzzing.h"
#include "ply_mutator.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size)
{
	std::istringstream in = fuzzing::streamOf(data, size);
	try {
		fuzzing::workOn(fuzzing::readSkeletonPly(fuzzing::readBinaryPly(in)).skeleton);
	}
	catch (const fuzzing::FormatError&) {
	}
	return 0;
}
