// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The stages of a run that will become layers, and their fields, computed during the flow.

#ifndef MCFSKEL_KEPT_STAGES_H
#define MCFSKEL_KEPT_STAGES_H

#include "stage_fields.h"

#include <atomic>
#include <condition_variable>
#include <deque>
#include <future>
#include <memory>
#include <mutex>
#include <thread>

namespace mcfskel {

/**
 * Stages in the order of their iterations.
 *
 * Computing the fields of a stage takes about as long as the next iteration of the flow. With more
 * than one core a worker thread begins as soon as a stage is added, and while a FlowShare lives,
 * the flow leaves that thread a core. The fields are bitwise the same with and without the thread.
 */
class KeptStages
{
public:
	using StagePointer = std::shared_ptr<const vcg::tri::mcf::Stage>;

	KeptStages();
	/// Cancels the fields that are still being computed.
	~KeptStages();
	KeptStages(const KeptStages&) = delete;
	KeptStages& operator=(const KeptStages&) = delete;

	void add(StagePointer stage);

	bool empty() const { return kept.empty(); }
	size_t size() const { return kept.size(); }
	const StagePointer& stage(size_t i) const { return kept[i].stage; }
	const StagePointer& last() const { return kept.back().stage; }

	/// The fields of stage i, which are moved out: waits for the worker thread, or computes them in
	/// this thread if the worker has not begun. @throws Cancelled
	StageFields takeFields(size_t i, const vcg::tri::mcf::Progress& progress);

	/// While it lives, parallel loops of this thread leave a core to the worker thread.
	class FlowShare
	{
	public:
		FlowShare();
		~FlowShare();
		FlowShare(const FlowShare&) = delete;
		FlowShare& operator=(const FlowShare&) = delete;

	private:
		int threads;
	};

private:
	using Task = std::packaged_task<StageFields()>;

	struct Kept
	{
		StagePointer stage;
		std::future<StageFields> fields;
		Task telling; ///< not valid once a thread has begun it
	};

	std::deque<Kept> kept; ///< a deque: its elements never move
	std::mutex mutex; ///< guards the tasks and the number of stages; held where `givenUp` is set
	std::condition_variable changed;
	std::atomic<bool> givenUp {false};
	std::thread teller;

	/// The task of stage i for the first caller; for later ones a task that is not valid.
	Task begin(size_t i);
	void tell();
};

} // namespace mcfskel

#endif
