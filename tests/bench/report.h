// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// What the two command line programs of the bench share: a stopwatch for processor and wall
// time, the peak memory of the process, a one-line JSON report and the OBJ form of a skeleton.
// Both programs use the same code here, so that their figures can be compared.

#ifndef MCFSKEL_BENCH_REPORT_H
#define MCFSKEL_BENCH_REPORT_H

#include <array>
#include <chrono>
#include <cmath>
#include <ctime>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace bench {

struct Seconds
{
	double cpu = 0.0;
	double wall = 0.0;

	Seconds& operator+=(const Seconds& other)
	{
		cpu += other.cpu;
		wall += other.wall;
		return *this;
	}
};

/// Processor time of the whole process (all threads) and wall time since the last call.
class Stopwatch
{
public:
	Stopwatch() { lap(); }

	Seconds lap()
	{
		std::timespec now {};
		clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
		const double cpu =
			static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
		const auto wall = std::chrono::steady_clock::now();
		const Seconds passed {cpu - cpu_, std::chrono::duration<double>(wall - wall_).count()};
		cpu_ = cpu;
		wall_ = wall;
		return passed;
	}

private:
	double cpu_ = 0.0;
	std::chrono::steady_clock::time_point wall_;
};

/// Largest resident size of this process so far (VmHWM), in MB of 1024 kB; 0 where unknown.
inline double peakMemory()
{
	std::ifstream status("/proc/self/status");
	for (std::string line; std::getline(status, line);)
		if (line.rfind("VmHWM:", 0) == 0)
			return std::stod(line.substr(6)) / 1024.0;
	return 0.0;
}

/// One JSON object on one line, its keys in the order in which they were added.
class Json
{
public:
	Json& add(const std::string& key, double value)
	{
		if (!std::isfinite(value))
			return addRaw(key, "null");
		std::ostringstream text;
		text << std::setprecision(9) << value;
		return addRaw(key, text.str());
	}

	Json& add(const std::string& key, std::size_t value)
	{
		return addRaw(key, std::to_string(value));
	}
	Json& add(const std::string& key, int value) { return addRaw(key, std::to_string(value)); }
	Json& add(const std::string& key, bool value) { return addRaw(key, value ? "true" : "false"); }
	Json& add(const std::string& key, const char* value) { return add(key, std::string(value)); }
	Json& add(const std::string& key, const std::string& value)
	{
		return addRaw(key, quoted(value));
	}
	Json& add(const std::string& key, const Json& value) { return addRaw(key, value.text()); }

	Json& add(const std::string& key, const Seconds& value)
	{
		return add(key, Json().add("cpu", value.cpu).add("wall", value.wall));
	}

	std::string text() const { return "{" + body_ + "}"; }

private:
	static std::string quoted(const std::string& value)
	{
		std::ostringstream text;
		text << '"';
		for (const char c : value) {
			if (c == '"' || c == '\\')
				text << '\\' << c;
			else if (static_cast<unsigned char>(c) < 0x20)
				text << "\\u00" << std::hex << std::setw(2) << std::setfill('0') << int(c)
					 << std::dec;
			else
				text << c;
		}
		text << '"';
		return text.str();
	}

	Json& addRaw(const std::string& key, const std::string& value)
	{
		body_ += (body_.empty() ? "" : ", ") + quoted(key) + ": " + value;
		return *this;
	}

	std::string body_;
};

/// A curve skeleton as the bench sees it: positions and pairs of their indices.
struct Curve
{
	std::vector<std::array<double, 3>> points;
	std::vector<std::pair<std::size_t, std::size_t>> edges;
	/// Of sheets; empty for a curve skeleton.
	std::vector<std::array<std::size_t, 3>> faces = {};
};

/// Writes @p curve as OBJ, one `l a b` line per edge, one `f a b c` line per face.
/// @throws std::runtime_error if the file cannot be written.
inline void writeObj(const Curve& curve, const std::string& path)
{
	std::ofstream out(path);
	out << std::setprecision(17);
	for (const auto& p : curve.points)
		out << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
	for (const auto& e : curve.edges)
		out << "l " << e.first + 1 << ' ' << e.second + 1 << '\n';
	for (const auto& f : curve.faces)
		out << "f " << f[0] + 1 << ' ' << f[1] + 1 << ' ' << f[2] + 1 << '\n';
	if (!out.flush())
		throw std::runtime_error("cannot write " + path);
}

/// Writes numbers, a line each.
inline void writeNumbers(const std::vector<double>& numbers, const std::string& path)
{
	std::ofstream out(path);
	out << std::setprecision(17);
	for (double number : numbers)
		out << number << '\n';
	if (!out.flush())
		throw std::runtime_error("cannot write " + path);
}

/// Runs a program's work; returns its exit status: 2 for std::invalid_argument, which is about how it
/// was called, 1 for any other exception.
template <class Work>
int runProgram(const char* name, const char* usage, Work&& work)
{
	try {
		work();
		return 0;
	}
	catch (const std::invalid_argument& error) {
		std::cerr << name << ": " << error.what() << '\n' << usage;
		return 2;
	}
	catch (const std::exception& error) {
		std::cerr << name << ": " << error.what() << '\n';
		return 1;
	}
}

} // namespace bench

#endif // MCFSKEL_BENCH_REPORT_H
