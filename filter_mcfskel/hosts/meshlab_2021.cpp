// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "meshlab_2021.h"

#include "../layers.h"

#include <common/parameters/rich_parameter_list.h>

using namespace mcfskel;

namespace {

const FilterSpec& spec(int id)
{
	return catalogue().at(size_t(id));
}

void addParameter(
	RichParameterList& list, const ParameterSpec& p, const MeshDocument& document, double diagonal)
{
	switch (p.kind) {
	case ParameterKind::Boolean:
		list.addParam(RichBool(p.name, p.defaultValue != 0, p.label, p.tooltip, p.advanced));
		break;
	case ParameterKind::Integer:
		list.addParam(RichInt(p.name, int(p.defaultValue), p.label, p.tooltip, p.advanced));
		break;
	case ParameterKind::Real:
		list.addParam(RichFloat(p.name, Scalarm(p.defaultValue), p.label, p.tooltip, p.advanced));
		break;
	case ParameterKind::Length:
		list.addParam(RichPercentage(p.name, defaultLength(p, diagonal), 0, Scalarm(diagonal),
			p.label, p.tooltip, p.advanced));
		break;
	case ParameterKind::Choice:
		list.addParam(
			RichEnum(p.name, int(p.defaultValue), p.choices, p.label, p.tooltip, p.advanced));
		break;
	case ParameterKind::Layer:
		list.addParam(RichMesh(p.name, document.mm() ? unsigned(document.mm()->id()) : 0, &document,
			p.label, p.tooltip, p.advanced));
		break;
	}
}

void readParameter(
	ParameterValues& values, const ParameterSpec& p, const RichParameterList& list, double diagonal)
{
	switch (p.kind) {
	case ParameterKind::Boolean: values.set(p.name, list.getBool(p.name)); break;
	case ParameterKind::Integer: values.set(p.name, list.getInt(p.name)); break;
	case ParameterKind::Real: values.set(p.name, double(list.getFloat(p.name))); break;
	case ParameterKind::Length: values.setLength(p, list.getAbsPerc(p.name), diagonal); break;
	case ParameterKind::Choice: values.set(p.name, list.getEnum(p.name)); break;
	case ParameterKind::Layer: values.set(p.name, list.getMeshId(p.name)); break;
	}
}

} // namespace

FilterMcfskelPlugin::FilterMcfskelPlugin()
{
	for (int id = 0; id < int(catalogue().size()); ++id) {
		typeList.push_back(id);
		actionList.push_back(new QAction(filterName(id), this));
	}
}

QString FilterMcfskelPlugin::pluginName() const
{
	return "FilterMcfskel";
}

QString FilterMcfskelPlugin::vendor() const
{
	return "Mean Curvature Skeletons contributors";
}

QString FilterMcfskelPlugin::filterName(ActionIDType id) const
{
	return spec(id).menuName;
}

QString FilterMcfskelPlugin::pythonFilterName(ActionIDType id) const
{
	return spec(id).pythonName;
}

QString FilterMcfskelPlugin::filterInfo(ActionIDType id) const
{
	return spec(id).help;
}

FilterPlugin::FilterClass FilterMcfskelPlugin::getClass(const QAction* action) const
{
	switch (spec(ID(action)).category) {
	case FilterCategory::Quality: return FilterPlugin::Quality;
	case FilterCategory::Remeshing: break;
	}
	return FilterPlugin::Remeshing;
}

FilterPlugin::FilterArity FilterMcfskelPlugin::filterArity(const QAction*) const
{
	return SINGLE_MESH;
}

int FilterMcfskelPlugin::getPreConditions(const QAction* action) const
{
	return spec(ID(action)).preConditions;
}

int FilterMcfskelPlugin::postCondition(const QAction*) const
{
	// Results are new layers and custom attributes; the layer that was there keeps what it had.
	return MeshModel::MM_NONE;
}

RichParameterList FilterMcfskelPlugin::initParameterList(
	const QAction* action, const MeshDocument& document)
{
	RichParameterList list;
	const double diagonal = document.mm() ? referenceDiagonal(*document.mm()) : 0;
	for (const ParameterSpec& p : spec(ID(action)).parameters)
		addParameter(list, p, document, diagonal);
	return list;
}

std::map<std::string, QVariant> FilterMcfskelPlugin::applyFilter(const QAction* action,
	const RichParameterList& parameters, MeshDocument& document, unsigned int&,
	vcg::CallBackPos* callback)
{
	const FilterSpec& filter = spec(ID(action));
	const double diagonal = document.mm() ? referenceDiagonal(*document.mm()) : 0;
	ParameterValues values;
	for (const ParameterSpec& p : filter.parameters)
		readParameter(values, p, parameters, diagonal);
	const Outcome outcome = runFilter(
		filter, document, values, [this](const QString& line) { log(line.toStdString()); },
		callback);
	if (!outcome.error.isEmpty())
		throw MLException(outcome.error);
	return outcome.results;
}

MESHLAB_PLUGIN_NAME_EXPORTER(FilterMcfskelPlugin)
