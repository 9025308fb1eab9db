// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Filter dialogs that fit the screen. MeshLab 2020.09 shows all parameters in a dialog that
/// cannot scroll: with a long list, Apply and Close would lie below the edge of the screen.

#ifndef MCFSKEL_SCROLLING_DIALOG_H
#define MCFSKEL_SCROLLING_DIALOG_H

#include <QApplication>
#include <QDockWidget>
#include <QScreen>
#include <QScrollArea>
#include <QScrollBar>
#include <QString>
#include <QTimer>
#include <QWidget>

#include <algorithm>

namespace mcfskel::host {

/// Makes the content of a dialog scroll where it is higher than the screen.
inline void scrollWhereTooHigh(QDockWidget& dialog)
{
	constexpr double share = 0.9; // of the screen's height: the rest is for frames and task bars
	QWidget* const content = dialog.widget();
	const QScreen* const screen = QApplication::primaryScreen();
	if (!content || !screen || qobject_cast<QScrollArea*>(content))
		return;
	// The host replaces the content for each filter and leaves the scroll area of the last one.
	for (QScrollArea* old :
		dialog.findChildren<QScrollArea*>(QString(), Qt::FindDirectChildrenOnly))
		if (!old->widget())
			old->deleteLater();
	const int highest = int(share * screen->availableGeometry().height());
	if (dialog.height() <= highest)
		return;
	auto* const area = new QScrollArea(&dialog);
	area->setFrameShape(QFrame::NoFrame);
	area->setWidgetResizable(true);
	area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
	const int width = std::max(dialog.width(), content->sizeHint().width())
		+ area->verticalScrollBar()->sizeHint().width();
	dialog.setWidget(area);
	area->setWidget(content);
	content->show();
	dialog.setMinimumSize(width, highest);
	dialog.resize(width, highest);
}

/// Calls scrollWhereTooHigh() for the dialog with this title as soon as the host has shown it.
inline void scrollDialogWhereTooHigh(const QString& title)
{
	QTimer::singleShot(0, qApp, [title] {
		for (QWidget* window : QApplication::topLevelWidgets())
			for (QDockWidget* dialog : window->findChildren<QDockWidget*>())
				if (dialog->windowTitle() == title && dialog->isVisible())
					scrollWhereTooHigh(*dialog);
	});
}

} // namespace mcfskel::host

#endif
