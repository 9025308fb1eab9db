// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The catalogue: what filters there are, their names, texts and parameters, and how to run
/// one. The adapters translate it for each plugin interface; a new filter is a file in
/// filters/ and a line in catalogue().

#ifndef MCFSKEL_FILTERS_H
#define MCFSKEL_FILTERS_H

#include "host/host_api.h"

#include <skeleton/support.h>

#include <QString>
#include <QStringList>
#include <QVariant>

#include <functional>
#include <map>
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
	/// The name that scripts use: an identity, never changed.
	QString name;
	/// Length: percent of the diagonal; Choice: index into `choices`; Boolean: 0 or 1; files: unused.
	double defaultValue;
	QString label;
	/// What it does, its unit, and what is sane.
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
 * @param diagonal of the layer, see referenceDiagonal().
 */
Scalarm defaultLength(const ParameterSpec& spec, double diagonal);

/// The values of a filter's parameters, by name.
class ParameterValues
{
public:
	void set(const QString& name, double value) { values[name] = value; }
	void setText(const QString& name, const QString& value) { texts[name] = value; }

	/**
	 * Takes a Length in mesh units and keeps it as a fraction of the diagonal, rounded so that hosts
	 * that count in float and in double, or show it in a dialog, get the same one, and with it the same
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

	/// The current layer. @pre the host has one, as runFilter() sees to if the filter needs it.
	MeshModel& layer() const { return *document.mm(); }
};

enum class FilterCategory { Remeshing, Quality };

struct FilterSpec
{
	/// The name that pymeshlab scripts use: an identity, never changed.
	QString pythonName;
	/// The name in the menus, and the identity in .mlx scripts, never changed.
	QString menuName;
	QString help;
	FilterCategory category;
	/// MeshModel::MeshElement bits that the current layer must have.
	int preConditions;
	std::vector<ParameterSpec> parameters;
	Results (*run)(FilterRun&);
	bool needsLayer = true;
	/// MeshModel::MeshElement bits that change on layers that were there before.
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

/// Receives the progress in percent and what is being done; returns false to cancel. May be empty.
using HostCallback = std::function<bool(int percent, const char* what)>;

/**
 * Runs a filter. This is the one boundary that no exception crosses: the hosts stop, with the user's
 * work lost, on most of them. After an error the document is as it was.
 */
Outcome runFilter(const FilterSpec& filter, MeshDocument& document,
	const ParameterValues& parameters, const std::function<void(const QString&)>& log,
	const HostCallback& callback);

} // namespace mcfskel

#endif
