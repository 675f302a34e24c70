// cobra_basis: measures for scripts/reproduce how the basis of an animation can be quantised
// and predicted.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/files/messages.h"
#include "common/json/json.h"
#include "conformance/studies/basis/basis_study.h"
#include "encoder/meshes/open/open_source.h"

namespace rlpc {
namespace {

constexpr std::size_t kShown = 10;  // number of vectors in the report

struct Options {
  InputOptions input;
  std::vector<std::size_t> counts{10, 20, 30, 40, 50};
  std::size_t tripled = 30;
  double kg = 0.1;
  std::vector<double> rates{1, 0.5, 0.2, 0.1, 0.05, 0.02};
};

// Reports, for each rule, errors with one step tripled, and the rate at several errors.
nlohmann::json rules(const TrajectoryBasis& basis, const Options& options) {
  const std::size_t count = std::min(options.tripled, basis.vectors.size());
  const auto vectors = std::span(basis.vectors).first(count);
  const BasisPredictor linear = basis_predictors(vectors).at(1 + kMaxPredicting + 1);
  nlohmann::json list;
  for (const StepRule rule : kStepRules) {
    const std::vector<double> relative = relative_steps(basis, rule, count);
    const std::vector<double> steps = steps_for(basis, relative, linear, options.kg);
    nlohmann::json rates = nlohmann::json::array();
    for (const double kg : options.rates) {
      const QuantisedBasis coded =
          quantise(vectors, steps_for(basis, relative, linear, kg), linear);
      rates.push_back({{"kg", kg_error(basis, coded.error)}, {"entropy", coded.entropy}});
    }
    list.push_back({{"name", name_of(rule)},
                    {"vectors", count},
                    {"predictor", linear.name},
                    {"steps", steps},
                    {"kg", kg_error(basis, quantise(vectors, steps, linear).error)},
                    {"tripled_kg", tripled(basis, steps, linear)},
                    {"rates", rates}});
  }
  return list;
}

// Reports, for each number of vectors, rule and predictor, prediction errors and entropy.
nlohmann::json predictors(const TrajectoryBasis& basis, const Options& options) {
  nlohmann::json list = nlohmann::json::array();
  for (const std::size_t count : options.counts) {
    if (count > basis.vectors.size()) continue;
    const auto vectors = std::span(basis.vectors).first(count);
    for (const StepRule rule : {StepRule::kUniform, StepRule::kCobra}) {
      const std::vector<double> relative = relative_steps(basis, rule, count);
      for (const BasisPredictor& predictor : basis_predictors(vectors)) {
        const std::vector<double> steps = steps_for(basis, relative, predictor, options.kg);
        list.push_back({{"vectors", count},
                        {"rule", name_of(rule)},
                        {"name", predictor.name},
                        {"squares", missed_squares(vectors, predictor)},
                        {"entropy", quantise(vectors, steps, predictor).entropy}});
      }
    }
  }
  return list;
}

nlohmann::json study(const Options& options) {
  auto source = open_frame_source(options.input);
  if (!source) throw std::runtime_error(source.error().message);
  if ((*source)->num_frames() <= kMaxPredicting) {
    throw std::runtime_error("expected at least " + std::to_string(kMaxPredicting + 1) +
                             " frames");
  }
  std::size_t max = std::max(options.tripled, kShown);
  for (const std::size_t count : options.counts) max = std::max(max, count);
  const auto basis = analyse_trajectories(**source, max);
  if (!basis) throw std::runtime_error(basis.error().message);
  if (basis->vectors.empty()) throw std::runtime_error("nothing moves, and nothing is apart");
  const auto shown = std::span(basis->vectors).first(std::min(kShown, basis->vectors.size()));
  return {{"num_vertices", basis->num_vertices},
          {"num_frames", basis->num_frames},
          {"total_energy", basis->total_energy},
          {"energy", basis->energy},
          {"sums", basis->sums},
          {"basis", std::vector(shown.begin(), shown.end())},
          {"kg", options.kg},
          {"rules", rules(*basis, options)},
          {"predictors", predictors(*basis, options)}};
}

}  // namespace
}  // namespace rlpc

int main(int argc, char** argv) try {
  rlpc::Options options;
  CLI::App app(
      "Measures how the basis of an animation can be quantised and predicted, as JSON");
  app.add_option("MESH", options.input.path, "Mesh, or animation")->required();
  app.add_option("--points", options.input.points, "Point cache");
  app.add_option("--vectors", options.counts, "Numbers of vectors for the predictors")
      ->delimiter(',')
      ->check(CLI::PositiveNumber);
  app.add_option("--tripled", options.tripled, "Number of vectors, one of which is coarser")
      ->check(CLI::PositiveNumber);
  app.add_option("--kg", options.kg, "KG error of the basis, per cent")
      ->check(CLI::PositiveNumber);
  app.add_option("--rates", options.rates, "The errors at which rates are measured")
      ->delimiter(',')
      ->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  std::cout << rlpc::json_text(rlpc::study(options), 1) << '\n' << std::flush;
  return std::cout ? 0 : 1;
} catch (const std::exception& error) {
  rlpc::print_message("cobra_basis", error.what());
  return 1;
}
