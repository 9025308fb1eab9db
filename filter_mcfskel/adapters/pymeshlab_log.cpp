// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "pymeshlab_log.h"

#include <QtGlobal>

#include <link.h>

#include <cstdint>
#include <exception>
#include <iostream>
#include <mutex>

namespace mcfskel::host {

namespace {

using Word = std::uintptr_t;

/// Guards `running` and, among filters of this plugin, pymeshlab's pointer to a log.
std::mutex mutex;
int running = 0;

/// A search for the word `value` in the writable memory of the module that contains `address`.
struct Search
{
	Word address;
	Word value;
	Word* found = nullptr;
	int times = 0;
};

bool contains(const dl_phdr_info& module, const ElfW(Phdr) & segment, Word address)
{
	const Word begin = module.dlpi_addr + segment.p_vaddr;
	return segment.p_type == PT_LOAD && address >= begin && address - begin < segment.p_memsz;
}

int searchModule(dl_phdr_info* module, size_t, void* data)
{
	Search& search = *static_cast<Search*>(data);
	const auto* const begin = module->dlpi_phdr;
	const auto* const end = begin + module->dlpi_phnum;
	if (std::none_of(begin, end,
			[&](const auto& segment) { return contains(*module, segment, search.address); }))
		return 0;
	for (const auto* segment = begin; segment != end; ++segment) {
		if (segment->p_type != PT_LOAD || !(segment->p_flags & PF_W))
			continue;
		const Word first = module->dlpi_addr + segment->p_vaddr;
		const Word last = first + segment->p_memsz;
		for (Word at = (first + sizeof(Word) - 1) / sizeof(Word) * sizeof(Word);
			 at + sizeof(Word) <= last; at += sizeof(Word)) {
			Word* const word = reinterpret_cast<Word*>(at);
			if (__atomic_load_n(word, __ATOMIC_RELAXED) != search.value)
				continue;
			search.found = word;
			++search.times;
		}
	}
	return 1;
}

/// Where std::cout, std::cerr and Qt's messages went when the plugin was loaded.
class Output
{
public:
	Output() : out(std::cout.rdbuf()), err(std::cerr.rdbuf()), qt(qInstallMessageHandler(nullptr))
	{
		restore();
	}

	void restore() const
	{
		std::cout.rdbuf(out);
		std::cerr.rdbuf(err);
		qInstallMessageHandler(qt);
	}

private:
	std::streambuf* out;
	std::streambuf* err;
	QtMessageHandler qt;
};

const Output output;

/// Sets pymeshlab's pointer to null if it points to this log.
void release(const GLLogStream& log, vcg::CallBackPos* callback)
{
	Search search {reinterpret_cast<Word>(callback), reinterpret_cast<Word>(&log)};
	dl_iterate_phdr(searchModule, &search);
	if (search.times == 1)
		__atomic_compare_exchange_n(
			search.found, &search.value, 0, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED);
}

} // namespace

PymeshlabLog::PymeshlabLog(
	MeshLabPluginLogger& plugin, MeshDocument& document, vcg::CallBackPos* callback) :
		plugin(plugin),
		log(document.Log), callback(callback), exceptions(std::uncaught_exceptions())
{
	const std::lock_guard<std::mutex> lock(mutex);
	++running;
	log.setBookmark();
}

PymeshlabLog::~PymeshlabLog()
{
	const bool failed = std::uncaught_exceptions() > exceptions;
	const std::lock_guard<std::mutex> lock(mutex);
	--running;
	if (failed) {
		plugin.setLog(nullptr);
		output.restore();
	}
	if (failed || running > 0)
		release(log, callback);
	log.backToBookmark();
	log.clearBookmark();
}

bool PymeshlabLog::progress(int percent, const char* what)
{
	const std::lock_guard<std::mutex> lock(mutex);
	return !callback || callback(percent, what);
}

} // namespace mcfskel::host
