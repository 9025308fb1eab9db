// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file Loops whose rounds do not depend on each other, on all cores where OpenMP is there.

#ifndef VCG_MCF_PARALLEL_BLOCKS_H
#define VCG_MCF_PARALLEL_BLOCKS_H

#include "progress.h"

#include <algorithm>

namespace vcg::tri::mcf {

/**
 * Calls body(begin, end) for consecutive blocks of [0, count), several at once.
 *
 * The blocks do not depend on the number of threads, so that a body whose result depends on its
 * block alone gives the same bits on any machine. The calling thread reports in between.
 * @param blocksPerReport  fewer where a round takes more than some 10 us.
 * @pre body throws nothing.
 * @throws Cancelled
 */
template <class Body>
void forEachBlock(int count, const Progress& progress, const char* what, const Body& body,
	int blocksPerReport = 32)
{
	constexpr int blockSize = 256;
	progress.report(0, what);
	const int blocks = (count + blockSize - 1) / blockSize;
	for (int first = 0; first < blocks; first += blocksPerReport) {
		const int last = std::min(first + blocksPerReport, blocks);
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic)
#endif
		for (int block = first; block < last; ++block)
			body(block * blockSize, std::min((block + 1) * blockSize, count));
		progress.report(double(last) / blocks, what);
	}
}

} // namespace vcg::tri::mcf

#endif
