// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Which of four numbers are small: the children into which a search in a tree descends.

#ifndef VCG_MCF_FOUR_VALUES_H
#define VCG_MCF_FOUR_VALUES_H

#include <Eigen/Core>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace vcg::tri::mcf {

/**
 * Writes first + k for those k from 3 down to 0 whose value is no more than `limit`, in this order.
 * Branchless: the comparisons are unpredictable.
 * @param to has room for four numbers; those after the returned count are undefined.
 * @return how many were within the limit.
 */
inline int writeWithin(const Eigen::Array4f& values, float limit, int first, int* to)
{
#ifdef __SSE2__
	// For each of the sixteen outcomes of the comparisons the numbers to be written, and how many.
	struct alignas(16) Answer
	{
		int numbers[4];
	};
	static constexpr Answer answers[16] = {{{0, 0, 0, 0}}, {{0, 0, 0, 0}}, {{1, 0, 0, 0}},
		{{1, 0, 0, 0}}, {{2, 0, 0, 0}}, {{2, 0, 0, 0}}, {{2, 1, 0, 0}}, {{2, 1, 0, 0}},
		{{3, 0, 0, 0}}, {{3, 0, 0, 0}}, {{3, 1, 0, 0}}, {{3, 1, 0, 0}}, {{3, 2, 0, 0}},
		{{3, 2, 0, 0}}, {{3, 2, 1, 0}}, {{3, 2, 1, 0}}};
	static constexpr signed char counts[16] = {0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};
	const int mask = _mm_movemask_ps(_mm_cmple_ps(_mm_loadu_ps(values.data()), _mm_set1_ps(limit)));
	const __m128i numbers = _mm_load_si128(reinterpret_cast<const __m128i*>(answers[mask].numbers));
	_mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm_add_epi32(numbers, _mm_set1_epi32(first)));
	return counts[mask];
#else
	int count = 0;
	for (int k = 3; k >= 0; --k) {
		to[count] = first + k;
		count += values[k] <= limit;
	}
	return count;
#endif
}

} // namespace vcg::tri::mcf

#endif
