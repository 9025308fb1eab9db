// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file The adapter for MeshLab and meshlabserver up to 2020.12: the catalogue as a
/// MeshFilterInterface.

#ifndef MCFSKEL_MESHLAB_2020_H
#define MCFSKEL_MESHLAB_2020_H

#include "../filters.h"

class FilterMcfskelPlugin : public QObject, public MeshFilterInterface
{
	Q_OBJECT
	Q_PLUGIN_METADATA(IID MESH_FILTER_INTERFACE_IID)
	Q_INTERFACES(MeshFilterInterface)

public:
	FilterMcfskelPlugin();

	QString pluginName() const override;
	QString filterName(FilterIDType id) const override;
	QString filterInfo(FilterIDType id) const override;
	FilterClass getClass(QAction* action) override;
	FILTER_ARITY filterArity(QAction* action) const override;
	int getPreConditions(QAction* action) const override;
	int postCondition(QAction* action) const override;
	void initParameterSet(
		QAction* action, MeshDocument& document, RichParameterList& list) override;
	bool applyFilter(QAction* action, MeshDocument& document, const RichParameterList& parameters,
		vcg::CallBackPos* callback) override;
};

#endif
