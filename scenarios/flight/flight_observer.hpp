#pragma once

namespace understory {

class Flight;

/// Observes a flight: a record, a film, a data set, a page. It can ask the flight for everything at each call
/// and cannot change it.
class FlightObserver {
 public:
  virtual ~FlightObserver() = default;

  /// Whether images must be rendered even where no detector looks at them. Called once, before the flight.
  virtual bool needs_images() const { return false; }
  /// The stage of result.json to which its wall time counts; a literal.
  virtual const char* stage() const { return "record"; }

  /// The autopilot has processed flight.frame(): hits and map are up to date.
  virtual void on_frame(const Flight&) {}
  /// Everything of this step is done except the physics.
  virtual void on_step(const Flight&) {}
};

}  // namespace understory
