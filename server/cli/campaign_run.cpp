#include <iostream>

#include "server/campaign/output.h"
#include "server/campaign/summary_json.h"
#include "server/cli/campaign.h"
#include "server/cli/cli.h"
#include "server/cli/interrupt.h"
#include "server/cli/progress_line.h"
#include "server/json/trial_json.h"

namespace stagger::server {
namespace {

using campaign::End;

void print_event(const Json& event) { std::cout << to_text(event) << std::endl; }

Json counts_json(const campaign::Progress& progress) {
  const campaign::Counts& counts = progress.counts;
  return {{"event", "progress"},       {"trials", counts.trials},       {"most", progress.most},
          {"round", progress.round},   {"recovered", counts.recovered}, {"fell", counts.fell},
          {"timeout", counts.timeout}, {"invalid", counts.invalid}};
}

Json trial_event(const campaign::Record& record) {
  return {{"event", "trial"},        {"number", record.number},
          {"id", record.id},         {"values", Json::parse(record.values)},
          {"repeat", record.repeat}, {"outcome", name_of(record.result.outcome)},
          {"passed", record.passed}};
}

/// "[##...] 240 of 960 trials, 12 falls, 1:05 left". `before`: done by earlier runs.
std::string progress_text(const campaign::Progress& progress, std::uint64_t before, bool at_most,
                          double elapsed_s) {
  const auto done = static_cast<double>(progress.counts.trials);
  const auto most = static_cast<double>(std::max(progress.most, progress.counts.trials));
  const double now = done - static_cast<double>(before);
  const std::string bound = at_most ? "at most " : "";
  return progress_bar(done / most) + " " + std::to_string(progress.counts.trials) + " of " + bound +
         std::to_string(progress.most) + " trials, " + std::to_string(progress.counts.fell) +
         " falls, " + bound + minutes_text(elapsed_s / std::max(now, 1.0) * (most - done)) +
         " left";
}

/// Says aloud what must not be overlooked.
void complain(const campaign::Folder& folder, const campaign::Summary& summary, End end) {
  if (!summary.mismatches.empty()) {
    std::cerr << "stagger: THIS CAMPAIGN IS INVALID: run twice, these trials gave two results:";
    for (const std::uint64_t number : summary.mismatches) std::cerr << ' ' << number;
    std::cerr << "\nstagger: a trial has to repeat to the bit; nothing here is to be trusted\n";
  }
  if (summary.counts.invalid > 0) {
    std::cerr << "stagger: " << summary.counts.invalid
              << " trials are invalid: they say nothing about the push\n";
  }
  if (end == End::aborted) std::cerr << "stagger: a threshold failed that ends the campaign\n";
  if (end == End::stopped) {
    std::cerr << "stagger: interrupted after " << summary.counts.trials
              << " trials; go on with: stagger campaign resume " << folder.path().string() << '\n';
  }
}

int exit_code(const campaign::Summary& summary, End end) {
  if (end == End::stopped) return exit_interrupted;
  if (!summary.mismatches.empty() || summary.counts.invalid > 0) return exit_invalid;
  return end == End::aborted || !summary.thresholds_passed() ? exit_no : exit_ok;
}

}  // namespace

int run_folder(const campaign::Folder& folder, const campaign::Plan& plan, campaign::Store& store,
               const CampaignOptions& options) {
  listen_for_interrupts();
  End end = End::complete;
  {
    ProgressLine line(options.quiet);
    const std::uint64_t before = store.count();
    if (options.json) {
      print_event({{"event", "start"},
                   {"name", plan.spec().name},
                   {"folder", folder.path().string()},
                   {"trials", before},
                   {"most", plan.design().most_trials()}});
    }
    campaign::CampaignOptions run;
    if (options.threads > 0) run.runner.threads = options.threads;
    run.runner.stop = [] { return interrupted(); };
    run.watch = [&](const campaign::Record& record, const campaign::Progress& progress) {
      if (options.json) {
        print_event(trial_event(record));
        if (progress.counts.trials % 100 == 0) print_event(counts_json(progress));
      }
      line.show([&](double elapsed_s) {
        return progress_text(progress, before, plan.design().is_bisection(), elapsed_s);
      });
    };
    end = campaign::run_campaign(plan, store, run);
  }
  return conclude(folder, plan, store, end, options);
}

int conclude(const campaign::Folder& folder, const campaign::Plan& plan,
             const campaign::Store& store, End end, const CampaignOptions& options) {
  const campaign::Summary summary = campaign::summarize(plan, store);
  folder.write_files(plan, store, summary);
  if (options.json) {
    print_event({{"event", "summary"}, {"summary", summary_json(plan, store, summary)}});
  } else {
    std::cout << summary_text(plan, summary);
  }
  complain(folder, summary, end);
  return exit_code(summary, end);
}

}  // namespace stagger::server
