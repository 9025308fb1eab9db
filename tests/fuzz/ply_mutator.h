// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/**
 * @file
 * @brief How inputs of the targets that read PLY are changed: a value in one of the tables for half of them,
 * bytes for the others, most of which end in the header.
 */

#ifndef MCFSKEL_FUZZ_PLY_MUTATOR_H
#define MCFSKEL_FUZZ_PLY_MUTATOR_H

#include "../unit/changed_fields.h"
#include "fuzzing.h"

#include <cstring>
#include <random>

extern "C" size_t LLVMFuzzerMutate(std::uint8_t* data, size_t size, size_t maxSize);

extern "C" size_t LLVMFuzzerCustomMutator(
	std::uint8_t* data, size_t size, size_t maxSize, unsigned int seed)
{
	using namespace fuzzing;
	std::mt19937 random(seed);
	if (random() % 4 == 0)
		return LLVMFuzzerMutate(data, size, maxSize);
	std::string bytes;
	try {
		std::istringstream in = streamOf(data, size);
		PlyFile ply = readBinaryPly(in);
		if (!changed_fields::changeTables(ply, random))
			return LLVMFuzzerMutate(data, size, maxSize);
		bytes = written([&](std::ostream& out) { writeBinaryPly(out, ply); });
	}
	catch (const FormatError&) {
		return LLVMFuzzerMutate(data, size, maxSize);
	}
	if (bytes.size() > maxSize)
		return LLVMFuzzerMutate(data, size, maxSize);
	std::memcpy(data, bytes.data(), bytes.size());
	return bytes.size();
}

#endif
