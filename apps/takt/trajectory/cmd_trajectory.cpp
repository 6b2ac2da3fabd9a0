#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <iostream>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/duration.hpp"
#include "apps/command_line/failure.hpp"
#include "apps/command_line/live_arguments.hpp"
#include "apps/takt/trajectory/trajectory_line.hpp"
#include "apps/takt/trajectory/trajectory_plot.hpp"

namespace takt {
namespace {

constexpr int no_solution = 1;

struct TrajectoryArguments {
  std::string file = "-";
  std::string sample;
  std::string plot;
};

/// Answers the requests of a stream, line by line.
class Requests {
 public:
  Requests(std::string name, std::optional<Time> sample)
      : name_{std::move(name)}, sample_{sample} {}

  void answer_all(std::istream& input) {
    std::string line;
    while (std::getline(input, line)) {
      ++number_;
      if (line.find_first_not_of(" \t\r") != std::string::npos) answer(line);
    }
  }

  int exit_code() const { return exit_code_; }
  const std::optional<TrajectoryAnswer>& first() const { return first_; }

 private:
  void answer(const std::string& line) {
    auto request = read_trajectory_request(line);
    if (!request) return refuse(request.error(), exit_wrong_use);
    auto planned = answer_trajectory(std::move(*request));
    if (!planned) return refuse(planned.error(), no_solution);
    const auto text = trajectory_json(*planned, sample_);
    if (!text) return refuse(text.error(), exit_wrong_use);
    std::cout << *text << '\n';
    if (!first_) first_ = std::move(*planned);
  }

  /// Reports a wrong line with its number. The answer to the line has the same sentence, so that
  /// the answers have the order of the requests.
  void refuse(const std::string& why, int code) {
    if (code == exit_wrong_use) complain(name_ + ":" + std::to_string(number_) + ": " + why, code);
    std::cout << trajectory_error_json(why) << '\n';
    exit_code_ = std::max(exit_code_, code);
  }

  std::string name_;
  std::optional<Time> sample_;
  std::size_t number_ = 0;
  int exit_code_ = 0;
  std::optional<TrajectoryAnswer> first_;
};

int plot(const std::string& path, const std::optional<TrajectoryAnswer>& answer) {
  if (!answer) return complain("--plot: no line has a trajectory", no_solution);
  std::ofstream file{path};
  file << trajectory_svg(*answer);
  file.close();
  return file.good() ? 0 : complain("can't write " + path, exit_wrong_use);
}

int run(const TrajectoryArguments& options) {
  std::optional<Time> sample;
  if (!options.sample.empty()) {
    sample = parse_duration(options.sample);
    if (!sample || *sample <= Time{0}) {
      return complain("--sample " + options.sample + ": expected a time such as 1ms",
                      exit_wrong_use);
    }
  }
  const bool from_stdin = options.file == "-";
  std::ifstream file;
  if (!from_stdin) {
    file.open(options.file);
    if (!file) return complain("can't read " + options.file, exit_wrong_use);
  }
  Requests requests{from_stdin ? "stdin" : options.file, sample};
  requests.answer_all(from_stdin ? std::cin : file);
  const int drawn = options.plot.empty() ? 0 : plot(options.plot, requests.first());
  return std::max(requests.exit_code(), drawn);
}

}  // namespace

void add_trajectory(CLI::App& app, int& exit_code) {
  auto [verb, options] = add_command<TrajectoryArguments>(app, exit_code, "trajectory",
                                                          "plans trajectories without a bus", run);
  verb.add_option("FILE", options.file, "requests, one JSON object a line; - is stdin")
      ->capture_default_str();
  verb.add_option("--sample", options.sample, "also print the states at this interval")
      ->type_name("TIME");
  verb.add_option("--plot", options.plot, "draw the first trajectory as an SVG file")
      ->type_name("FILE");
  verb.footer(
      "Prints one JSON object for each request, in the same order. Units are those of the\n"
      "request, times are in seconds. Exit code 1: a request has no solution, and its `error`\n"
      "is a sentence. Exit code 2: a line can't be read.\n\n"
      "Example:\n"
      "  echo '{\"from\":{\"position\":[0]},\"to\":{\"position\":[1]},\"limits\":"
      "{\"velocity\":[1],\\\n"
      "    \"acceleration\":[5],\"jerk\":[50]}}' | takt trajectory --plot move.svg");
}

}  // namespace takt
