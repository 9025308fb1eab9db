// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Progress reports from inside long loops.

#ifndef VCG_MCF_TICKER_H
#define VCG_MCF_TICKER_H

#include "progress.h"

#include <algorithm>
#include <cstdint>

namespace vcg::tri::mcf::detail {

/// Counts elements; at intervals, reports progress and checks for cancellation.
class Ticker
{
public:
	/// @param expected number of elements, exact or estimated.
	Ticker(const Progress& progress, const char* what, double expected) :
			progress(progress), what(what), expected(std::max(expected, 1.0))
	{
		progress.report(0, what);
	}
	void tick()
	{
		if (++count % reportEvery == 0)
			progress.report(double(count) / expected, what);
	}
	/// Checks for cancellation now. @throws Cancelled
	void check() const { progress.check(); }

private:
	static constexpr std::uint64_t reportEvery = 1 << 15;
	const Progress progress;
	const char* what;
	double expected;
	std::uint64_t count = 0;
};

/// Calls visit(i) for all i in [0, count), in this order, and checks for cancellation at intervals.
/// @throws Cancelled
template <class Visit>
void cancellableLoop(int count, const Cancellation& cancel, Visit&& visit)
{
	constexpr int askEvery = 1 << 15;
	for (int begin = 0; begin < count;) {
		cancel.check();
		const int end = count - begin > askEvery ? begin + askEvery : count;
		for (; begin < end; ++begin)
			visit(begin);
	}
}

/// As cancellableLoop(), and reports progress.
/// @throws Cancelled
template <class Visit>
void reportedLoop(int count, const Progress& progress, const char* what, Visit&& visit)
{
	constexpr int reportEvery = 1 << 15;
	for (int begin = 0; begin < count;) {
		progress.report(double(begin) / count, what);
		const int end = count - begin > reportEvery ? begin + reportEvery : count;
		for (; begin < end; ++begin)
			visit(begin);
	}
}

} // namespace vcg::tri::mcf::detail

#endif
