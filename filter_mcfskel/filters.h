// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The catalogue of filters: their names, texts and parameters, and how to run one. The
/// adapters translate it for each plugin interface. A new filter is a file in filters/ with a line
/// in filters/all_filters.h and one in catalogue().

#ifndef MCFSKEL_FILTERS_H
#define MCFSKEL_FILTERS_H

#include "host/host_api.h"
#include "layers/layer_as_read.h"

#include <skeleton/support.h>

#include <QString>
#include <QStringList>
#include <QVariant>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace mcfskel {

enum class ParameterKind {
	Boolean,
	Integer,
	Real,
	Length, ///< MeshLab's percentage of the bounding box diagonal
	Choice,
	Layer,
	FileToOpen, ///< a name; `choices` holds patterns such as *.ply
	FileToSave
};

struct ParameterSpec
{
	ParameterKind kind;
	/// The name in scripts. It must never change.
	QString name;
	/// Length: percent of the diagonal; Choice: an index; Boolean: 0 or 1; Layer and files: unused.
	double defaultValue;
	QString label;
	/// What the parameter does, its unit and its recommended range.
	QString tooltip;
	QStringList choices = {};
	bool advanced = false;

	ParameterSpec asAdvanced() const
	{
		ParameterSpec spec = *this;
		spec.advanced = true;
		return spec;
	}
};

/**
 * The default of a Length in mesh units, as the host holds it.
 * @param diagonal of the layer, mesh units, see referenceDiagonal().
 */
Scalarm defaultLength(const ParameterSpec& spec, double diagonal);

/// The values of a filter's parameters, by name.
class ParameterValues
{
public:
	void set(const QString& name, double value) { values[name] = value; }
	void setText(const QString& name, const QString& value) { texts[name] = value; }

	/**
	 * Takes a Length in mesh units and keeps it as a fraction of the diagonal. It is rounded, so
	 * that hosts with floats, with doubles and with a dialog get the same fraction, and so the same
	 * results.
	 */
	void setLength(const ParameterSpec& spec, Scalarm length, double diagonal);

	double real(const char* name) const { return values.at(name); }
	int integer(const char* name) const { return int(values.at(name)); }
	bool flag(const char* name) const { return values.at(name) != 0; }
	/// A Length, as a fraction of the bounding box diagonal.
	double fraction(const char* name) const { return values.at(name); }
	/// The name of a file.
	QString text(const char* name) const { return texts.at(name); }

private:
	std::map<QString, double> values;
	std::map<QString, QString> texts;
};

/// Numbers by name: int, double or Eigen::VectorXd only, since nothing else reaches Python safely.
using Results = std::map<std::string, QVariant>;

/// What a filter is given to run.
struct FilterRun
{
	MeshDocument& document;
	const ParameterValues& parameters;
	/// Writes one line into the host's log.
	std::function<void(const QString&)> log;
	vcg::tri::mcf::Progress progress;
	/// The layer that was current when the filter began, if there was one.
	std::optional<LayerAsRead> current;

	/// That layer, whichever is current by now. @throws InvalidInput: see LayerAsRead::in()
	/// @pre There is one: runFilter() checks it where FilterSpec::needsLayer.
	MeshModel& layer() const { return current->in(document); }
};

enum class FilterCategory { Remeshing, Quality };

struct FilterSpec
{
	/// The name in pymeshlab scripts. It must never change.
	QString pythonName;
	/// The name in the menus and in .mlx scripts. It must never change.
	QString menuName;
	QString help;
	FilterCategory category;
	/// MeshModel::MeshElement bits that the current layer must have.
	int preConditions;
	std::vector<ParameterSpec> parameters;
	Results (*run)(FilterRun&);
	bool needsLayer = true;
	/// MeshModel::MeshElement bits that the filter changes on existing layers.
	int changes = MeshModel::MM_NONE;
};

/// Every filter, in the order in which a user meets them.
const std::vector<FilterSpec>& catalogue();

/// The outcome of a filter: its numbers, or why there are none.
struct Outcome
{
	Results results;
	/// Empty if the filter succeeded; else one sentence or two for the user.
	QString error;
};

/// Reads the values of a filter's parameters from the host's.
using ParameterReader = std::function<ParameterValues()>;

/// Receives the progress in percent and what is being done; returns false to cancel. May be empty.
using HostCallback = std::function<bool(int percent, const char* what)>;

/**
 * Runs a filter. It is the plugin's one exception boundary: most exceptions would end the host, and
 * the user's work would be lost. After an error the document is unchanged.
 */
Outcome runFilter(const FilterSpec& filter, MeshDocument& document,
	const ParameterReader& parameters, const std::function<void(const QString&)>& log,
	const HostCallback& callback);

} // namespace mcfskel

#endif
