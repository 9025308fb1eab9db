// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "meshlab_2020.h"

#include "../layers.h"

using namespace mcfskel;

namespace {

const FilterSpec& spec(int id)
{
	return catalogue().at(size_t(id));
}

void addParameter(
	RichParameterList& list, const ParameterSpec& p, MeshDocument& document, double diagonal)
{
	switch (p.kind) {
	case ParameterKind::Boolean:
		list.addParam(RichBool(p.name, p.defaultValue != 0, p.label, p.tooltip));
		break;
	case ParameterKind::Integer:
		list.addParam(RichInt(p.name, int(p.defaultValue), p.label, p.tooltip));
		break;
	case ParameterKind::Real:
		list.addParam(RichFloat(p.name, float(p.defaultValue), p.label, p.tooltip));
		break;
	case ParameterKind::Length:
		list.addParam(RichAbsPerc(
			p.name, defaultLength(p, diagonal), 0, float(diagonal), p.label, p.tooltip));
		break;
	case ParameterKind::Choice:
		list.addParam(RichEnum(p.name, int(p.defaultValue), p.choices, p.label, p.tooltip));
		break;
	case ParameterKind::Layer:
		list.addParam(RichMesh(p.name, document.mm(), &document, p.label, p.tooltip));
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
	case ParameterKind::Layer: values.set(p.name, list.getMesh(p.name)->id()); break;
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

QString FilterMcfskelPlugin::filterName(FilterIDType id) const
{
	return spec(id).menuName;
}

QString FilterMcfskelPlugin::filterInfo(FilterIDType id) const
{
	return spec(id).help;
}

MeshFilterInterface::FilterClass FilterMcfskelPlugin::getClass(QAction* action)
{
	switch (spec(ID(action)).category) {
	case FilterCategory::Quality: return MeshFilterInterface::Quality;
	case FilterCategory::Remeshing: break;
	}
	return MeshFilterInterface::Remeshing;
}

MeshFilterInterface::FILTER_ARITY FilterMcfskelPlugin::filterArity(QAction*) const
{
	return SINGLE_MESH;
}

int FilterMcfskelPlugin::getPreConditions(QAction* action) const
{
	return spec(ID(action)).preConditions;
}

int FilterMcfskelPlugin::postCondition(QAction*) const
{
	// Results are new layers and custom attributes; the layer that was there keeps what it had.
	return MeshModel::MM_NONE;
}

void FilterMcfskelPlugin::initParameterSet(
	QAction* action, MeshDocument& document, RichParameterList& list)
{
	const double diagonal = document.mm() ? referenceDiagonal(*document.mm()) : 0;
	for (const ParameterSpec& p : spec(ID(action)).parameters)
		addParameter(list, p, document, diagonal);
}

bool FilterMcfskelPlugin::applyFilter(QAction* action, MeshDocument& document,
	const RichParameterList& parameters, vcg::CallBackPos* callback)
{
	const FilterSpec& filter = spec(ID(action));
	const double diagonal = document.mm() ? referenceDiagonal(*document.mm()) : 0;
	ParameterValues values;
	for (const ParameterSpec& p : filter.parameters)
		readParameter(values, p, parameters, diagonal);
	const auto writeLog = [this](const QString& line) { Log(line.toStdString()); };
	const Outcome outcome = runFilter(filter, document, values, writeLog, callback);
	if (outcome.error.isEmpty())
		return true;
	// meshlabserver does not print errorMessage, so the log gets the reason as well.
	errorMessage = outcome.error;
	writeLog(outcome.error);
	return false;
}
