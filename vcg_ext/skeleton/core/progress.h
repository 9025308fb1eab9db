// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Progress reports and cancelling, the same for every stage.

#ifndef VCG_MCF_PROGRESS_H
#define VCG_MCF_PROGRESS_H

#include "errors.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>

namespace vcg::tri::mcf {

/**
 * The cancellation token of a job: long loops, copies and sorts check it at intervals.
 *
 * Copies are the same token. Only the thread that runs the job checks it, see forEachBlock() and
 * forEachPart().
 */
class Cancellation
{
public:
	/// Takes (percent in [0, 100], what is being done); returns false to cancel.
	using Callback = std::function<bool(int, const char*)>;

	/// A token that is never cancelled.
	Cancellation() = default;

	/// Calls back with what was reported last, so that the progress bar stays where it is.
	/// @throws Cancelled if the callback answers false.
	void check() const
	{
		if (job && !job->callback(job->percent, job->what))
			throw Cancelled();
	}

protected:
	struct Job
	{
		Callback callback;
		int percent = 0;
		const char* what = "Starting";
	};
	/// Null without a callback.
	std::shared_ptr<Job> job;
};

/**
 * A window into a progress bar; also the job's cancellation token.
 *
 * A stage reports fractions in [0, 1] of its own work; its caller decides by part() which piece of
 * the whole bar that is. The bar moves forwards only, if fractions and windows are in order.
 */
class Progress : public Cancellation
{
public:
	/// A silent progress that never cancels.
	Progress() = default;

	explicit Progress(Callback callback)
	{
		if (callback)
			job = std::make_shared<Job>(Job {std::move(callback)});
	}

	/// The piece [from, to] of this window, in fractions of it.
	Progress part(double from, double to) const
	{
		Progress piece = *this;
		piece.low = low + from * (high - low);
		piece.high = low + to * (high - low);
		return piece;
	}

	/// A progress that only checks for cancellation: for steps that are too short to be shown.
	Progress cancelOnly() const
	{
		Progress hidden = *this;
		hidden.isShown = false;
		return hidden;
	}

	/// A progress that is shown and cannot be cancelled: for steps that must not end halfway.
	Progress showOnly() const
	{
		Progress shown = *this;
		if (job)
			shown.job = std::make_shared<Job>(Job {[job = job](int percent, const char* what) {
													   job->percent = percent;
													   job->what = what;
													   job->callback(percent, what);
													   return true;
												   },
				job->percent, job->what});
		return shown;
	}

	/**
	 * Reports that `fraction` of this window's work is done.
	 * @throws Cancelled if the callback answers false.
	 */
	void report(double fraction, const char* what) const
	{
		if (!job)
			return;
		if (isShown) {
			const double clamped = std::clamp(fraction, 0.0, 1.0);
			job->percent = int(100 * (low + clamped * (high - low)));
			job->what = what;
		}
		check();
	}

private:
	double low = 0;
	double high = 1;
	bool isShown = true;
};

} // namespace vcg::tri::mcf

#endif
