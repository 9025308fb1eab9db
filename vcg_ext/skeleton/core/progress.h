// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Progress reports and cancelling, the same for every stage.

#ifndef VCG_MCF_PROGRESS_H
#define VCG_MCF_PROGRESS_H

#include "errors.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace vcg::tri::mcf {

/**
 * A window into a progress bar.
 *
 * A stage reports fractions in [0, 1] of its own work; whoever calls the stage decides by part()
 * which piece of the whole bar that is. The bar never moves backwards.
 */
class Progress
{
public:
	/// Takes (percent in [0, 100], what is being done); returns false to cancel.
	using Callback = std::function<bool(int, const char*)>;

	/// A silent progress that never cancels.
	Progress() = default;

	explicit Progress(Callback callback) : callback(std::move(callback)) {}

	/// The piece [from, to] (fractions of this window) as a window of its own.
	Progress part(double from, double to) const
	{
		Progress piece = *this;
		piece.low = low + from * (high - low);
		piece.high = low + to * (high - low);
		return piece;
	}

	/**
	 * Reports that `fraction` of this window's work is done.
	 * @throws Cancelled if the callback answers false.
	 */
	void report(double fraction, const char* what) const
	{
		if (!callback)
			return;
		const double clamped = std::clamp(fraction, 0.0, 1.0);
		if (!callback(int(100 * (low + clamped * (high - low))), what))
			throw Cancelled();
	}

private:
	Callback callback;
	double low = 0;
	double high = 1;
};

} // namespace vcg::tri::mcf

#endif
