// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Chunked allocation and copying of large arrays, which the user can cancel.
///
/// First-touch page faults can be slow, a few GB in ten seconds on a virtual machine: a single
/// allocation of 100 MB would block cancellation for half a second.

#ifndef VCG_MCF_LARGE_ARRAYS_H
#define VCG_MCF_LARGE_ARRAYS_H

#include "progress.h"
#include "ticker.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace vcg::tri::mcf::detail {

/// Elements of a large array that are made between two checks for cancellation: 4 MB.
template <class T>
constexpr size_t pieceOf = (size_t(1) << 22) / sizeof(T);

/// Replaces the contents of an array by `count` copies of `value`. @throws Cancelled
template <class T>
void fillArray(std::vector<T>& array, size_t count, const T& value, const Cancellation& cancel)
{
	array.clear();
	array.reserve(count);
	while (array.size() < count) {
		cancel.check();
		array.resize(std::min(count, array.size() + pieceOf<T>), value);
	}
}

/// An array of `count` elements, all of them `value`. @throws Cancelled
template <class T>
std::vector<T> filledArray(size_t count, const T& value, const Cancellation& cancel)
{
	std::vector<T> array;
	fillArray(array, count, value, cancel);
	return array;
}

/// A copy of an array. @throws Cancelled
template <class T>
std::vector<T> copiedArray(const std::vector<T>& array, const Cancellation& cancel)
{
	std::vector<T> copy;
	copy.reserve(array.size());
	while (copy.size() < array.size()) {
		cancel.check();
		const size_t end = std::min(array.size(), copy.size() + pieceOf<T>);
		copy.insert(copy.end(), array.begin() + long(copy.size()), array.begin() + long(end));
	}
	return copy;
}

/// 0, 1, 2, ..., count - 1. @throws Cancelled
inline std::vector<int> numberedArray(size_t count, const Cancellation& cancel)
{
	std::vector<int> numbers;
	numbers.reserve(count);
	cancellableLoop(int(count), cancel, [&](int i) { numbers.push_back(i); });
	return numbers;
}

} // namespace vcg::tri::mcf::detail

#endif
