// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "filters.h"

#if !MCFSKEL_IN_MESHLAB
#include "cancel_flag.h"
#endif
#include "filters/all_filters.h"
#include "layers/fields.h"
#include "layers/layers.h"

#include <skeleton/support.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <memory>
#include <new>
#include <optional>

namespace mcfskel {

namespace {

/// Passes progress on to the host: each new percentage at once, the same one at most every 50 ms,
/// since a GUI redraws each time. The bar never moves back, even where a step is tried again.
vcg::tri::mcf::Progress hostProgress(const HostCallback& callback)
{
	using Clock = std::chrono::steady_clock;
#if MCFSKEL_IN_MESHLAB
	const volatile int* const cancel = nullptr;
#else
	const volatile int* const cancel = cancelFlag();
#endif
	if (!callback && !cancel)
		return {};
	struct Last
	{
		int percent = -1;
		Clock::time_point time = Clock::time_point::min();
	};
	// Shared by all windows into the bar, which copy the function.
	return vcg::tri::mcf::Progress(
		[callback, cancel, last = std::make_shared<Last>()](int percent, const char* what) {
			if (cancel && *cancel)
				return false;
			percent = std::max(percent, last->percent);
			const auto now = Clock::now();
			if (percent == last->percent && now < last->time + std::chrono::milliseconds(50))
				return true;
			*last = {percent, now};
			return !callback || callback(percent, what);
		});
}

QString valueText(const QVariant& value)
{
	if (!value.canConvert<Eigen::VectorXd>())
		return value.toString();
	QStringList numbers;
	for (double number : value.value<Eigen::VectorXd>())
		numbers << QString::number(number);
	return "(" + numbers.join(' ') + ")";
}

QString resultsText(const Results& results)
{
	QStringList parts;
	for (const auto& [name, value] : results)
		parts << QString("%1 = %2").arg(QString::fromStdString(name), valueText(value));
	return parts.join(", ");
}

/// Whether this build has a filter.
bool isOffered(const char* pythonName)
{
	return std::any_of(catalogue().begin(), catalogue().end(),
		[&](const FilterSpec& filter) { return filter.pythonName == pythonName; });
}

/// What cures a defect in MeshLab, as a sentence to append to the library's; empty if nothing does.
QString cureInMeshLab(vcg::tri::mcf::Defect defect)
{
	using vcg::tri::mcf::Defect;
	const QString makeSolid =
		isOffered("generate_solid_mcf") ? "Run 'Make Solid'" : "Set 'repair' to 'auto'";
	switch (defect) {
	case Defect::NoFaces:
		return " Make a surface of the points first, e.g. with 'Surface Reconstruction: Screened "
			   "Poisson'.";
	case Defect::NotFinite:
		return QString(
				   " Select them with 'Conditional Vertex Selection' and the function x!=x || y!=y || z!=z "
				   "|| abs(x)>1e300 || abs(y)>1e300 || abs(z)>1e300, delete them, and run 'Close Holes'; or ")
			+ makeSolid.left(1).toLower() + makeSolid.mid(1) + ".";
	case Defect::NonManifoldEdges:
		return " " + makeSolid
			+ "; or 'Repair non Manifold Edges' with the method 'Split Vertices', "
			  "then, where there are border edges, 'Close Holes'.";
	case Defect::NonManifoldVertices:
		return " " + makeSolid + ", or 'Repair non Manifold Vertices by splitting'.";
	case Defect::OneSided: return " " + makeSolid + ", which wraps it.";
	case Defect::BorderEdges:
		return " " + makeSolid
			+ "; or 'Close Holes' with a maximum size of at least that number; where a hole remains, "
			  "again without 'Prevent creation of selfIntersecting faces'; a stray piece, which is no hole, "
			  "goes with 'Remove Isolated pieces (wrt Diameter)'.";
	case Defect::NoVolume:
		return " 'Remove Isolated pieces (wrt Diameter)' does the latter, with a diameter above that of "
			   "the flat part.";
	case Defect::OpenSheet:
		return isOffered("generate_solid_mcf")
			? " 'Make Solid' gives it one, with a 'sheet_thickness' of 1 %, for example."
			: " 'Uniform Mesh Resampling' gives it one, with 'Absolute Distance' and an offset above 50 %.";
	case Defect::Other:
	case Defect::Empty:
	case Defect::Flat: break;
	}
	return "";
}

/// A legend for the colours of a new layer without faces; empty if no window shows it.
QString legend(const MeshModel& layer)
{
	if (!host::hasWindow() || layer.cm.fn > 0)
		return {};
	const std::vector<double> thickness = vertexQuality(layer);
	if (thickness.empty())
		return {};
	return QString("Colours: from blue, 0, to red, a thickness of %1.")
		.arg(*std::max_element(thickness.begin(), thickness.end()));
}

/// The percentage that a dialog showed, with three decimals. The dialog returns mesh units in steps
/// of 1e-7 times the power of ten above the diagonal, so that even untouched defaults change.
double percentInDialog(double percent, double diagonal)
{
	const double shown = std::round(1000 * percent) / 1000;
	const double step = std::pow(10, std::ceil(std::log10(diagonal)) - 7);
	const double rounding = 100 * step / diagonal / 2 + 1e-6 * percent;
	return std::abs(shown - percent) <= rounding ? shown : percent;
}

} // namespace

Scalarm defaultLength(const ParameterSpec& spec, double diagonal)
{
	return Scalarm(spec.defaultValue / 100 * diagonal);
}

void ParameterValues::setLength(const ParameterSpec& spec, Scalarm length, double diagonal)
{
	// Six digits of a percentage are the same in hosts with single and with double precision.
	double percent = diagonal > 0 ? 100 * double(float(length)) / diagonal : 0;
	percent = QString::number(percent, 'g', 6).toDouble();
	if (diagonal > 0 && host::hasWindow())
		percent = percentInDialog(percent, diagonal);
	set(spec.name, percent / 100);
}

const std::vector<FilterSpec>& catalogue()
{
	static const std::vector<FilterSpec> filters = {
		makeSolidFilter(),
		resampleFilter(),
		medialPolesFilter(),
		contractionStepFilter(),
		collapseToCurveFilter(),
		refineSkeletonFilter(),
		fullSkeletonizeFilter(),
		surfacePartsFilter(),
		pruneSkeletonFilter(),
		resampleSkeletonFilter(),
		compareSkeletonsFilter(),
		measureSkeletonFilter(),
		medialAxisFilter(),
		medialBallsFilter(),
		skeletonTubesFilter(),
		saveStageFilter(),
		loadStageFilter(),
		saveSkeletonFilter(),
		saveProjectFilter(),
	};
	return filters;
}

Outcome runFilter(const FilterSpec& filter, MeshDocument& document,
	const ParameterReader& parameters, const std::function<void(const QString&)>& log,
	const HostCallback& callback)
{
	Outcome outcome;
	try {
		if (filter.needsLayer && !document.mm())
			throw vcg::tri::mcf::InvalidInput(
				"There is no layer: open a closed triangle mesh first.");
		const ParameterValues values = parameters();
		FilterRun run {document, values, log, hostProgress(callback), std::nullopt};
		if (document.mm())
			run.current.emplace(*document.mm());
		const MeshModel* const before = document.mm();
		outcome.results = filter.run(run);
		try {
			log(resultsText(outcome.results));
			if (document.mm() && document.mm() != before)
				if (const QString text = legend(*document.mm()); !text.isEmpty())
					log(text);
		}
		catch (const std::bad_alloc&) {
			// The results are in the document already: the filter has succeeded.
		}
	}
	catch (const vcg::tri::mcf::Cancelled&) {
		outcome.error = "Cancelled; nothing was changed.";
	}
	catch (const vcg::tri::mcf::InvalidInput& error) {
		outcome.error = QString::fromUtf8(error.what()) + cureInMeshLab(error.defect());
	}
	catch (const std::bad_alloc&) {
		outcome.error = "Not enough memory for this mesh; nothing was changed.";
	}
	catch (const std::exception& error) {
		outcome.error = QString::fromUtf8(error.what());
	}
	catch (...) {
		outcome.error = "An error of unknown kind; nothing was changed.";
	}
	return outcome;
}

} // namespace mcfskel
