// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "translate.h"

#include "../layers/layers.h"

namespace mcfskel::host {

namespace {

/// Passes a type as an argument.
template <class T>
struct Tag
{
	using Type = T;
};

/// Six digits, so that 0.1 is the same number in hosts that count in float and in double.
double toReal(Scalarm value)
{
	return QString::number(double(value), 'g', 6).toDouble();
}

double diagonalOf(const MeshDocument& document)
{
	return document.mm() ? referenceDiagonal(*document.mm()) : 0;
}

/// Sets the default of a parameter for the current layer.
void setDefault(
	ParameterValues& values, const ParameterSpec& p, const MeshDocument& document, double diagonal)
{
	switch (p.kind) {
	case ParameterKind::Boolean:
	case ParameterKind::Integer:
	case ParameterKind::Choice: values.set(p.name, p.defaultValue); break;
	case ParameterKind::Real: values.set(p.name, toReal(Scalarm(p.defaultValue))); break;
	case ParameterKind::Length: values.setLength(p, defaultLength(p, diagonal), diagonal); break;
	case ParameterKind::Layer:
		values.set(p.name, document.mm() ? int(document.mm()->id()) : -1);
		break;
	case ParameterKind::FileToOpen:
	case ParameterKind::FileToSave: values.setText(p.name, QString()); break;
	}
}

} // namespace

const FilterSpec& filterOf(int id)
{
	return catalogue().at(size_t(id));
}

void addParameters(RichParameterList& list, const FilterSpec& filter, ParameterDocument& document)
{
	const double diagonal = diagonalOf(document);
	for (const ParameterSpec& p : filter.parameters) {
		const auto add = [&](auto type, auto&&... values) {
			using Rich = typename decltype(type)::Type;
			list.addParam(makeParameter<Rich>(p.advanced, p.name, values..., p.label, p.tooltip));
		};
		switch (p.kind) {
		case ParameterKind::Boolean: add(Tag<RichBool>(), p.defaultValue != 0); break;
		case ParameterKind::Integer: add(Tag<RichInt>(), int(p.defaultValue)); break;
		case ParameterKind::Real: add(Tag<RichFloat>(), Scalarm(p.defaultValue)); break;
		case ParameterKind::Length:
			add(Tag<RichPercentage>(), defaultLength(p, diagonal), Scalarm(0), Scalarm(diagonal));
			break;
		case ParameterKind::Choice: add(Tag<RichEnum>(), int(p.defaultValue), p.choices); break;
		case ParameterKind::Layer: add(Tag<RichMesh>(), currentLayer(document), &document); break;
		case ParameterKind::FileToOpen: add(Tag<RichFileOpen>(), QString(), p.choices); break;
		case ParameterKind::FileToSave:
			add(Tag<RichFileSave>(), QString(), p.choices.join(' '));
			break;
		}
	}
}

ParameterValues readParameters(
	const RichParameterList& list, const FilterSpec& filter, const MeshDocument& document)
{
	const double diagonal = diagonalOf(document);
	ParameterValues values;
	for (const ParameterSpec& p : filter.parameters) {
		if (!list.hasParameter(p.name)) {
			setDefault(values, p, document, diagonal);
			continue;
		}
		switch (p.kind) {
		case ParameterKind::Boolean: values.set(p.name, list.getBool(p.name)); break;
		case ParameterKind::Integer: values.set(p.name, list.getInt(p.name)); break;
		case ParameterKind::Real: values.set(p.name, toReal(list.getFloat(p.name))); break;
		case ParameterKind::Length: values.setLength(p, list.getAbsPerc(p.name), diagonal); break;
		case ParameterKind::Choice: values.set(p.name, list.getEnum(p.name)); break;
		case ParameterKind::Layer: values.set(p.name, layerId(list, p.name)); break;
		case ParameterKind::FileToOpen: values.setText(p.name, list.getOpenFileName(p.name)); break;
		case ParameterKind::FileToSave: values.setText(p.name, list.getSaveFileName(p.name)); break;
		}
	}
	return values;
}

FilterBase::FilterClass filterClass(const FilterSpec& filter)
{
	switch (filter.category) {
	case FilterCategory::Quality: return FilterBase::Quality;
	case FilterCategory::Remeshing: break;
	}
	return FilterBase::Remeshing;
}

} // namespace mcfskel::host
