#pragma once

#include <string>
#include <vector>

#include "scenarios/campaign/flight_row.hpp"
#include "scenarios/report/line_plot.hpp"

namespace understory {

/// Share of flights that reached the goal, with 95 % Wilson bars, over the speed asked (m/s). A series for
/// all that else distinguishes conditions: their names without "cruise_speed_mps=..."; conditions that come
/// out with one name differ in nothing but the speed and are joined by a line. Points are set a little apart
/// sideways where series share a speed.
LinePlot success_over_speed(const std::vector<FlightRow>& rows);

/// The same over trees per 100 m^2, names without "square_metres_per_tree=...".
LinePlot success_over_density(const std::vector<FlightRow>& rows);

/// The same side by side: a place per condition.
LinePlot success_by_condition(const std::vector<FlightRow>& rows);

/// Share of flights that get beyond each distance (m of progress): Kaplan and Meier's steps with 95 % bands,
/// at most six conditions to a panel, those of a scenario together where they fit.
std::vector<LinePlot> survival_curves(const std::vector<FlightRow>& rows);

/// One SVG: success over speed and over density, each where conditions differ in nothing else, or else by
/// condition; then survival.
/// Flights that failed to run enter nothing. Empty where none was flown.
std::string campaign_svg(const std::vector<FlightRow>& rows);

}  // namespace understory
