#include "tests/validation/estimator_page.hpp"

#include "tests/validation/consistency_section.hpp"
#include "tests/validation/drift_section.hpp"

namespace understory {

ValidationPage estimator_page(const std::filesystem::path& root) {
  ValidationPage page;
  page.file = "estimator";
  page.title = "The estimator";
  page.introduction =
      "The filter (`estimation/filter`) along simulated forest flights, beside the truth. "
      "`./run validate --only estimator` writes this page and its figures, and ends with status 1 where one "
      "of "
      "its "
      "tolerances is broken. The flights are flown on true depth and true state, so that every filter is "
      "given "
      "the same ones; obstacles at the detection depths are then seen as a pushbroom sees them, every trunk "
      "in "
      "view at the whole disparity's depth, one latency late.\n\n"
      "The map's frame: in flight no correction moves the estimate's position or heading, so that points "
      "stay "
      "where they were seen; roll and pitch are corrected; heights over the ground follow the barometer "
      "beside "
      "it (`State::altitude_m`). A gain that is withheld costs knowledge, and the covariance says so "
      "(Joseph's "
      "form with the gain as it is).\n";
  page.sections = {matched_consistency_section(root, 100), turbulent_consistency_section(root, 100),
                   drift_section(root, 24)};
  return page;
}

}  // namespace understory
