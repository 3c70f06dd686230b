#include "scenarios/evaluation/image_statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <random>

#include "perception/pushbroom/block_rule.hpp"
#include "scenarios/output/errors.hpp"
#include "scenarios/report/sheet_page.hpp"
#include "scenarios/statistics/statistics.hpp"

namespace understory {
namespace {

constexpr int papers_edge_sum = 860, frequency_bins = 64;
constexpr double papers_score_limit = 54.0 / 333.0, lowest_frequency = 0.02, highest_frequency = 0.3;
/// A match by chance lies this far from the true one, at least and at most.
constexpr int chance_from_px = 8, chance_to_px = 60;

/// All that is gathered over the pairs before it becomes figures.
struct Gathered {
  std::vector<double> power = std::vector<double>(frequency_bins), weight = power;
  std::vector<double> edge_sums, grays, true_sads, chance_sads, true_scores, chance_scores;
  std::vector<std::pair<double, double>> noise, pair_noise;  ///< edge sum, mean absolute answer
  double along = 0, across = 0, steps = 0, clipped = 0, pixels = 0;
};

cv::Mat edges_of(const cv::Mat& image) {
  cv::Mat edges;
  cv::Laplacian(image, edges, CV_8U, 3);
  return edges;
}

void add_spectrum(const cv::Mat& image, Gathered& gathered) {
  cv::Mat values, window, spectrum;
  image.convertTo(values, CV_64F);
  values -= cv::mean(values);
  cv::createHanningWindow(window, values.size(), CV_64F);
  cv::dft(values.mul(window), spectrum, cv::DFT_COMPLEX_OUTPUT);
  for (int row = 0; row < spectrum.rows; ++row)
    for (int column = 0; column <= spectrum.cols / 2; ++column) {
      const double across = static_cast<double>(row <= spectrum.rows / 2 ? row : row - spectrum.rows) /
                            spectrum.rows,
                   along = static_cast<double>(column) / spectrum.cols;
      const double frequency = std::hypot(across, along);
      const auto bin = static_cast<std::size_t>(2 * frequency_bins * frequency);
      if (bin >= gathered.power.size()) continue;
      const auto value = spectrum.at<cv::Vec2d>(row, column);
      gathered.power[bin] += (value[0] * value[0] + value[1] * value[1]) / static_cast<double>(image.total());
      ++gathered.weight[bin];
    }
}

/// The mean absolute answer of a block to the mask [1 -2 1; -2 4 -2; 1 -2 1].
double answer_in(const cv::Mat& answers, int column, int row) {
  return cv::mean(answers(cv::Rect(column, row, block_px, block_px)))[0];
}

cv::Mat mask_answers(const cv::Mat& values) {
  const cv::Mat mask = (cv::Mat_<float>(3, 3) << 1, -2, 1, -2, 4, -2, 1, -2, 1);
  cv::Mat answers;
  cv::filter2D(values, answers, CV_32F, mask);
  return cv::abs(answers);
}

/// Of a normal variable of standard deviation 1 the mask's answer is 6 times as wide, and its mean absolute
/// value the square root of 2/pi of that.
double noise_of(std::vector<std::pair<double, double>> blocks) {
  if (blocks.empty()) return std::nan("");
  std::ranges::sort(blocks);
  const std::size_t flattest = (blocks.size() + 9) / 10;
  double sum = 0;
  for (std::size_t i = 0; i < flattest; ++i) sum += blocks[i].second;
  return sum / static_cast<double>(flattest) * std::sqrt(std::numbers::pi / 2) / 6;
}

void add_steps(const cv::Mat& image, Gathered& gathered) {
  for (int row = 1; row < image.rows; ++row)
    for (int column = 1; column < image.cols; ++column) {
      const int here = image.at<std::uint8_t>(row, column);
      gathered.along += std::abs(here - image.at<std::uint8_t>(row, column - 1));
      gathered.across += std::abs(here - image.at<std::uint8_t>(row - 1, column));
      gathered.steps += 1;
    }
  for (int row = 0; row < image.rows; row += 3)
    for (int column = 0; column < image.cols; column += 3)
      gathered.grays.push_back(image.at<std::uint8_t>(row, column));
  gathered.clipped += cv::countNonZero(image == 0) + cv::countNonZero(image == 255);
  gathered.pixels += static_cast<double>(image.total());
}

/// The whole disparity of a block that lies within a quarter of a pixel of it everywhere; nothing otherwise.
std::optional<int> whole_disparity(const cv::Mat& disparity_px, int column, int row) {
  const auto nearest = static_cast<int>(std::lround(disparity_px.at<float>(row, column)));
  for (int v = row; v < row + block_px; ++v)
    for (int u = column; u < column + block_px; ++u)
      if (!(std::abs(disparity_px.at<float>(v, u) - static_cast<float>(nearest)) <= 0.25F)) return {};
  return nearest;
}

void add_blocks(const ImagePair& pair, std::mt19937_64& generator, Gathered& gathered) {
  cv::Mat left_sums, right_sums;
  const cv::Size block(block_px, block_px);
  cv::boxFilter(edges_of(pair.left), left_sums, CV_32S, block, {0, 0}, false);
  cv::boxFilter(edges_of(pair.right), right_sums, CV_32S, block, {0, 0}, false);
  const cv::Mat answers = mask_answers(pair.left);
  const auto sad = [&](int column, int row, int right) {
    return block_sad(pair.left.ptr(row) + column, static_cast<std::ptrdiff_t>(pair.left.step),
                     pair.right.ptr(row) + right, static_cast<std::ptrdiff_t>(pair.right.step));
  };
  for (int row = block_px; row + 2 * block_px <= pair.left.rows; row += block_px)
    for (int column = block_px; column + 2 * block_px <= pair.left.cols; column += block_px) {
      const int edge_sum = left_sums.at<int>(row, column);
      gathered.edge_sums.push_back(edge_sum);
      // Where the image is clipped there is no noise to be seen.
      const cv::Mat content = pair.left(cv::Rect(column, row, block_px, block_px));
      const bool is_clipped = cv::countNonZero(content == 0) + cv::countNonZero(content == 255) > 0;
      if (!is_clipped) gathered.noise.emplace_back(edge_sum, answer_in(answers, column, row));
      const auto compare = [&](int right, std::vector<double>& sads, std::vector<double>& scores) {
        const int difference = sad(column, row, right), other = right_sums.at<int>(row, right);
        sads.push_back(difference);
        if (edge_sum > papers_edge_sum && other > papers_edge_sum)
          scores.push_back(static_cast<double>(difference) / (edge_sum + other));
      };
      const std::optional<int> known =
          pair.disparity_px.empty() ? std::nullopt : whole_disparity(pair.disparity_px, column, row);
      const int center = column - known.value_or(0);
      const int by = chance_from_px + static_cast<int>(generator() % (chance_to_px - chance_from_px));
      const int chance = generator() % 2 == 0 ? center - by : center + by;
      if (chance >= 0 && chance + block_px <= pair.right.cols)
        compare(chance, gathered.chance_sads, gathered.chance_scores);
      if (!known || is_clipped || center < 1 || center + block_px + 1 > pair.right.cols) continue;
      compare(center, gathered.true_sads, gathered.true_scores);
      cv::Mat difference;  // with a border of a pixel, which the mask needs
      const cv::Rect around(column - 1, row - 1, block_px + 2, block_px + 2);
      cv::subtract(pair.left(around), pair.right(cv::Rect(center - 1, row - 1, block_px + 2, block_px + 2)),
                   difference, cv::noArray(), CV_32F);
      gathered.pair_noise.emplace_back(edge_sum, answer_in(mask_answers(difference), 1, 1));
    }
}

double median_of(const std::vector<double>& values) {
  return values.empty() ? std::nan("") : quantile(values, 0.5);
}

/// By least squares over the logarithms.
double slope_of(const ImageStatistics& statistics) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t i = 0; i < statistics.frequency.size(); ++i) {
    if (statistics.frequency[i] < lowest_frequency || statistics.frequency[i] > highest_frequency) continue;
    const double a = std::log(statistics.frequency[i]), b = std::log(statistics.power[i]);
    n += 1, x += a, y += b, xx += a * a, xy += a * b;
  }
  return -(n * xy - x * y) / (n * xx - x * x);
}

void take_spectrum(const Gathered& gathered, ImageStatistics& statistics) {
  for (std::size_t bin = 1; bin < gathered.power.size(); ++bin) {
    if (gathered.weight[bin] == 0) continue;
    statistics.frequency.push_back((static_cast<double>(bin) + 0.5) / (2 * frequency_bins));
    statistics.power.push_back(gathered.power[bin] / gathered.weight[bin]);
  }
  statistics.power_slope = slope_of(statistics);
  const double first = statistics.power.front();
  for (double& power : statistics.power) power /= first;
}

}  // namespace

ImageStatistics image_statistics(const std::string& name, const std::vector<ImagePair>& pairs) {
  if (pairs.empty()) throw ScenarioError(name + ": holds no pair");
  Gathered gathered;
  std::mt19937_64 generator(1);
  for (const ImagePair& pair : pairs) {
    if (pair.left.cols < 32 || pair.left.rows < 32)
      throw ScenarioError(fmt::format("{}: {}: must be at least 32 pixels wide and high, is {}x{}", name,
                                      pair.name, pair.left.cols, pair.left.rows));
    add_spectrum(pair.left, gathered);
    add_steps(pair.left, gathered);
    add_blocks(pair, generator, gathered);
  }
  ImageStatistics statistics;
  statistics.name = name;
  statistics.pairs = static_cast<int>(pairs.size());
  statistics.width_px = pairs[0].left.cols;
  statistics.height_px = pairs[0].left.rows;
  take_spectrum(gathered, statistics);
  const auto share = [](const std::vector<double>& values, auto&& holds) {
    return values.empty() ? std::nan("")
                          : static_cast<double>(std::ranges::count_if(values, holds)) /
                                static_cast<double>(values.size());
  };
  statistics.edges_over_860 = share(gathered.edge_sums, [](double sum) { return sum > papers_edge_sum; });
  statistics.median_edge_sum = median_of(gathered.edge_sums);
  for (int percent = 0; percent <= 100; ++percent)
    statistics.edge_sums.push_back(quantile(gathered.edge_sums, percent / 100.0));
  statistics.along_gray = gathered.along / gathered.steps;
  statistics.across_gray = gathered.across / gathered.steps;
  statistics.noise_gray = noise_of(gathered.noise);
  statistics.pair_noise_gray = noise_of(gathered.pair_noise) / std::numbers::sqrt2;
  statistics.true_sad = median_of(gathered.true_sads);
  statistics.chance_sad = median_of(gathered.chance_sads);
  statistics.true_score = median_of(gathered.true_scores);
  statistics.chance_score = median_of(gathered.chance_scores);
  statistics.confused =
      share(gathered.chance_scores, [](double score) { return score < papers_score_limit; });
  statistics.mean_gray = mean_of(gathered.grays);
  statistics.dark_gray = quantile(gathered.grays, 0.05);
  statistics.bright_gray = quantile(gathered.grays, 0.95);
  statistics.clipped = gathered.clipped / gathered.pixels;
  return statistics;
}

Table image_table(const std::vector<ImageStatistics>& all) {
  Table table{{"source", "pairs", "size", "power slope", "edge sum over 860", "median edge sum", "step along",
               "step across", "noise", "noise of pairs", "SAD true", "SAD by chance", "S true", "S by chance",
               "confused", "mean gray", "5 %", "95 %", "clipped"}};
  for (const ImageStatistics& one : all)
    table.add(one.name, one.pairs, fmt::format("{}x{}", one.width_px, one.height_px),
              number_text(one.power_slope, 2), number_text(one.edges_over_860, 3),
              number_text(one.median_edge_sum, 0), number_text(one.along_gray, 2),
              number_text(one.across_gray, 2), number_text(one.noise_gray, 2),
              number_text(one.pair_noise_gray, 2), number_text(one.true_sad, 0),
              number_text(one.chance_sad, 0), number_text(one.true_score, 3),
              number_text(one.chance_score, 3), number_text(one.confused, 3), number_text(one.mean_gray, 0),
              number_text(one.dark_gray, 0), number_text(one.bright_gray, 0), number_text(one.clipped, 4));
  return table;
}

std::vector<LinePlot> image_plots(const std::vector<ImageStatistics>& all) {
  LinePlot spectra{.title = "Power over spatial frequency, relative to the lowest",
                   .x_label = "log10 of cycles a pixel",
                   .y_label = "log10 of power"},
      edges{.title = "Edge sums of blocks", .x_label = "edge sum", .y_label = "% of blocks below"};
  for (const ImageStatistics& one : all) {
    Series& power = spectra.series.emplace_back(Series{.name = one.name});
    for (std::size_t i = 0; i < one.frequency.size(); ++i) {
      power.x.push_back(std::log10(one.frequency[i]));
      power.y.push_back(std::log10(one.power[i]));
    }
    Series& sums = edges.series.emplace_back(Series{.name = one.name});
    for (std::size_t percent = 0; percent < one.edge_sums.size(); ++percent) {
      sums.x.push_back(one.edge_sums[percent]);
      sums.y.push_back(static_cast<double>(percent));
    }
  }
  edges.references.push_back({papers_edge_sum, "the paper's threshold", true});
  return {spectra, edges};
}

std::string image_page(const std::vector<ImageStatistics>& all, const std::filesystem::path& data_root) {
  return sheet_page(data_root, "Statistics of images",
                    "What a block matcher depends on, of each source of stereo pairs (docs/realism.md).",
                    {{.title = "Sources", .table = image_table(all)},
                     {.title = "Distributions", .plots = image_plots(all)}});
}

}  // namespace understory
