// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "kept_stages.h"

#ifdef _OPENMP
#include <omp.h>
#endif

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

/// How many threads the loops of this thread use; one without OpenMP.
int threadCount()
{
#ifdef _OPENMP
	return omp_get_max_threads();
#else
	return 1;
#endif
}

void setThreadCount([[maybe_unused]] int count)
{
#ifdef _OPENMP
	omp_set_num_threads(count);
#endif
}

} // namespace

KeptStages::KeptStages()
{
	if (threadCount() > 1)
		try {
			teller = std::thread([this] { tell(); });
		}
		catch (const std::system_error&) {
			// No thread can be started: takeFields() does the work.
		}
}

KeptStages::~KeptStages()
{
	if (!teller.joinable())
		return;
	{
		// Without the lock the thread might miss it just before it waits.
		const std::lock_guard<std::mutex> lock(mutex);
		givenUp = true;
	}
	changed.notify_one();
	teller.join();
}

void KeptStages::add(StagePointer stage)
{
	Task task([this, stage] {
		return stageFields(*stage, mcf::Progress([this](int, const char*) { return !givenUp; }));
	});
	{
		const std::lock_guard<std::mutex> lock(mutex);
		kept.push_back({std::move(stage), task.get_future(), std::move(task)});
	}
	changed.notify_one();
}

KeptStages::Task KeptStages::begin(size_t i)
{
	const std::lock_guard<std::mutex> lock(mutex);
	return std::exchange(kept[i].telling, Task());
}

void KeptStages::tell()
{
	setThreadCount(1);
	for (size_t i = 0;; ++i) {
		{
			std::unique_lock<std::mutex> lock(mutex);
			changed.wait(lock, [&] { return givenUp || i < kept.size(); });
			if (givenUp)
				return;
		}
		if (Task task = begin(i); task.valid())
			task();
	}
}

StageFields KeptStages::takeFields(size_t i, const mcf::Progress& progress)
{
	if (begin(i).valid())
		return stageFields(*kept[i].stage, progress);
	while (kept[i].fields.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready)
		progress.report(0, "Telling curves from sheets");
	return kept[i].fields.get();
}

KeptStages::FlowShare::FlowShare() : threads(threadCount())
{
	setThreadCount(std::max(threads - 1, 1));
}

KeptStages::FlowShare::~FlowShare()
{
	setThreadCount(threads);
}

} // namespace mcfskel
