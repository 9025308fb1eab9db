// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The stages of a run that will become layers, and their fields, told while the flow goes on.

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
 * To tell the fields of a stage takes about as long as to make the next one. Where there is more than one
 * core, a thread of its own does that from the moment a stage is added, and while FlowShare lives, the flow
 * leaves that thread a core. The fields are the same bits either way.
 */
class KeptStages
{
public:
	using StagePointer = std::shared_ptr<const vcg::tri::mcf::Stage>;

	KeptStages();
	/// Fields that are still being told are given up.
	~KeptStages();
	KeptStages(const KeptStages&) = delete;
	KeptStages& operator=(const KeptStages&) = delete;

	void add(StagePointer stage);

	bool empty() const { return kept.empty(); }
	size_t size() const { return kept.size(); }
	const StagePointer& stage(size_t i) const { return kept[i].stage; }
	const StagePointer& last() const { return kept.back().stage; }

	/// The fields of stage i, once: waited for, or told by this thread if that one has not begun with them.
	/// @throws Cancelled
	StageFields takeFields(size_t i, const vcg::tri::mcf::Progress& progress);

	/// While it lives, parallel loops of this thread leave a core to the one that tells fields.
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
		Task telling; ///< not valid once a thread has begun with it
	};

	std::deque<Kept> kept; ///< a deque: what is in it stays in its place
	std::mutex mutex; ///< of the tasks and of the number of stages; held where `givenUp` is set
	std::condition_variable changed;
	std::atomic<bool> givenUp {false};
	std::thread teller;

	/// The task of stage i for the one who asks first; for all others one that is not valid.
	Task begin(size_t i);
	void tell();
};

} // namespace mcfskel

#endif
