#include "server/cli/campaign.h"

#include <iostream>

#include "server/campaign/output.h"
#include "server/campaign/plan_check.h"
#include "server/campaign/shards.h"
#include "server/campaign/summary_json.h"
#include "server/cli/cli.h"
#include "server/cli/input.h"
#include "sim/json_file.h"

namespace stagger::server {
namespace {

using campaign::Folder;
using campaign::Plan;
using campaign::Store;

/// A campaign on disk, with the plan that its store holds.
struct Opened {
  Opened(const std::string& path, Store::Access access, RobotLibrary& library) : folder(path) {
    if (!folder.holds_campaign()) throw std::runtime_error(path + ": holds no campaign");
    store.emplace(folder.store(), access);
    plan = load_plan(path + " (its specification)", store->specification(), library);
    if (plan == nullptr) throw std::runtime_error(path + ": cannot be used with these robots");
  }
  Folder folder;
  std::optional<Store> store;
  std::unique_ptr<Plan> plan;
};

int run(const CampaignOptions& options, RobotLibrary& library) {
  const std::string text = read_input(options.spec);
  const auto plan = load_plan(options.spec == "-" ? "standard input" : options.spec, text, library);
  if (plan == nullptr) return exit_usage;
  const Folder folder(options.out.empty() ? plan->spec().name + ".campaign" : options.out);
  folder.create(text);
  const campaign::FolderLock lock(folder);
  Store store(folder.store(), Store::Access::write);
  return run_folder(folder, *plan, store, options);
}

int resume(const CampaignOptions& options, RobotLibrary& library) {
  if (!Folder(options.folder).holds_campaign()) {
    throw std::runtime_error(options.folder + ": holds no campaign");
  }
  const campaign::FolderLock lock{Folder(options.folder)};
  Opened opened(options.folder, Store::Access::write, library);
  try {
    campaign::require_unchanged(*opened.plan, *opened.store);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(options.folder + ": " + error.what());
  }
  merge_shards(opened.folder, *opened.store);  // what a cluster has left behind
  return run_folder(opened.folder, *opened.plan, *opened.store, options);
}

int validate(const CampaignOptions& options, RobotLibrary& library) {
  const std::string text = read_input(options.spec);
  const auto plan = load_plan(options.spec == "-" ? "standard input" : options.spec, text, library);
  if (plan == nullptr) return exit_usage;
  const campaign::Design& design = plan->design();
  if (options.json) {
    std::cout << to_text({{"name", plan->spec().name},
                          {"cells", design.cells()},
                          {"most_trials", design.most_trials()}})
              << '\n';
  } else {
    std::cout << plan->spec().name << ": " << (design.is_bisection() ? "at most " : "")
              << design.most_trials() << " trials, " << design.cells() << " combinations\n";
  }
  return exit_ok;
}

int status(const CampaignOptions& options, RobotLibrary& library) {
  const Opened opened(options.folder, Store::Access::read, library);
  const campaign::Summary summary = campaign::summarize(*opened.plan, *opened.store);
  if (options.json) {
    std::cout << to_text(summary_json(*opened.plan, *opened.store, summary)) << '\n';
  } else {
    std::cout << summary_text(*opened.plan, summary);
    tell_slurm(opened.folder, *opened.store);
  }
  return exit_ok;
}

int report(const CampaignOptions& options, RobotLibrary& library) {
  const Opened opened(options.folder, Store::Access::read, library);
  const campaign::Summary summary = campaign::summarize(*opened.plan, *opened.store);
  const auto file = opened.folder.write_report(*opened.plan, *opened.store, summary);
  Json figures = Json::array();
  if (!options.figures.empty()) {
    for (const auto& figure :
         campaign::write_figures(options.figures, *opened.plan, *opened.store, summary)) {
      figures.push_back(figure.string());
    }
  }
  if (options.json) {
    std::cout << to_text({{"file", file.string()}, {"figures", figures}}) << '\n';
  } else {
    std::cout << file.string() << '\n';
    for (const Json& figure : figures) std::cout << figure.get<std::string>() << '\n';
  }
  return exit_ok;
}

int show(const CampaignOptions& options, RobotLibrary& library) {
  const Opened opened(options.folder, Store::Access::read, library);
  if (options.number >= opened.plan->design().numbers()) {
    throw std::runtime_error("trial " + std::to_string(options.number) + " is not of " +
                             options.folder + ", which has 0 to " +
                             std::to_string(opened.plan->design().numbers() - 1));
  }
  std::cout << opened.plan->trial(options.number).resolved.dump(2) << '\n';
  return exit_ok;
}

int compare(const CampaignOptions& options, RobotLibrary& library) {
  const Opened a(options.folder, Store::Access::read, library);
  const Opened b(options.other, Store::Access::read, library);
  const auto comparison =
      campaign::compare(*a.plan, *a.store, *b.plan, *b.store, options.tolerance);
  if (comparison.pairs == 0) {
    throw std::runtime_error("no trial of " + options.other + " has a partner in " +
                             options.folder);
  }
  if (options.json) {
    std::cout << to_text(comparison_json(comparison)) << '\n';
  } else {
    std::cout << comparison_text(comparison);
  }
  return comparison.regressions.empty() ? exit_ok : exit_no;
}

}  // namespace

std::unique_ptr<Plan> load_plan(const std::string& name, const std::string& text,
                                RobotLibrary& library) {
  sim::JsonErrors errors;
  std::unique_ptr<Plan> plan;
  try {
    campaign::CampaignSpec spec = campaign::read_campaign(sim::parse_json(text), errors);
    if (errors.empty()) {
      plan = std::make_unique<Plan>(std::move(spec), library);
      campaign::check_plan(*plan, errors);
    }
  } catch (const sim::JsonSyntaxError& error) {
    std::cerr << name << ':' << error.line << ':' << error.column << ": " << error.what() << '\n';
    return nullptr;
  }
  for (const sim::JsonError& error : errors.list()) {
    const sim::TextPosition at = sim::position_of(text, error.pointer);
    std::cerr << name << ':' << at.line << ':' << at.column << ": "
              << (error.pointer.empty() ? "" : error.pointer + " ") << error.text << '\n';
  }
  if (!errors.empty()) return nullptr;
  return plan;
}

CLI::App* add_campaign(CLI::App& app, CampaignOptions& options) {
  using Action = CampaignOptions::Action;
  CLI::App* command = app.add_subcommand("campaign", "Many trials: run, compare, gate");
  command->require_subcommand(1);
  const auto add = [&](const char* name, const char* about, Action action) {
    CLI::App* sub = command->add_subcommand(name, about);
    sub->callback([&options, action] { options.action = action; });
    sub->add_flag("--json", options.json, "Print JSON");
    return sub;
  };
  const auto add_running = [&](CLI::App* sub) {
    sub->add_option("--threads", options.threads, "Trials at a time; 0: one a core")
        ->check(CLI::Range(0, 1024));
    sub->add_flag("--quiet", options.quiet, "Do not tell how far it is");
  };
  const auto add_spec = [&](CLI::App* sub) {
    sub->add_option("spec", options.spec, "Specification (JSON), or - for standard input")
        ->required();
  };
  const auto add_folder = [&](CLI::App* sub) {
    sub->add_option("folder", options.folder, "Folder of a campaign")->required();
  };

  CLI::App* run_app = add("run", "Run a campaign", Action::run);
  add_spec(run_app);
  add_running(run_app);
  run_app->add_option("--out", options.out, "Folder to make (NAME.campaign)");
  add_spec(add("validate", "Check a specification", Action::validate));
  CLI::App* resume_app = add("resume", "Go on with a campaign", Action::resume);
  add_folder(resume_app);
  add_running(resume_app);
  add_folder(add("status", "Tell how far a campaign is and what it found", Action::status));
  CLI::App* report_app = add("report", "Write a campaign's report.html", Action::report);
  add_folder(report_app);
  report_app->add_option("--figures", options.figures,
                         "Folder for its figures too, each as an SVG file");
  CLI::App* show_app =
      add("trial", "Print one trial's specification, for `stagger trial -`", Action::show);
  add_folder(show_app);
  show_app->add_option("number", options.number, "Of the trial")->required();

  CLI::App* compare_app = add("compare", "Is the second campaign worse?", Action::compare);
  compare_app->add_option("a", options.folder, "Folder of the campaign before")->required();
  compare_app->add_option("b", options.other, "Folder of the campaign after")->required();
  compare_app
      ->add_option("--tolerance", options.tolerance.failures,
                   "Greater share of trials that do not pass that is tolerated")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  compare_app
      ->add_option("--limit-tolerance", options.tolerance.limit,
                   "Share of the push limits that may be lost, on the mean")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();

  const auto whole = [](CLI::App* sub, const char* name, std::uint64_t& value, const char* about) {
    sub->add_option(name, value, about)->check(CLI::Range(std::uint64_t{0}, std::uint64_t{10'000}));
  };
  CLI::App* submit_app = add("submit", "Run a campaign on a cluster", Action::submit);
  add_spec(submit_app);
  submit_app->add_flag("--slurm", options.slurm, "With sbatch, from a folder that all nodes share");
  submit_app->add_option("--out", options.out, "Folder to make (NAME.campaign)");
  submit_app->add_option("--shards", options.shards, "Jobs of a round at the most")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  submit_app->add_option("--threads", options.threads, "Cores of a job")
      ->check(CLI::Range(1, 1024));
  submit_app->add_option("--sbatch", options.sbatch, "An argument for sbatch; may be repeated")
      ->allow_extra_args(false);
  CLI::App* shard_app = add("shard", "Run one part of a round (a job calls it)", Action::shard);
  add_folder(shard_app);
  shard_app->add_option("--threads", options.threads, "Trials at a time")
      ->check(CLI::Range(1, 1024));
  whole(shard_app, "--round", options.round, "Number of the round");
  whole(shard_app, "--index", options.index, "Of the part");
  whole(shard_app, "--shards", options.shards, "Parts of the round");
  CLI::App* merge_app = add("merge", "Take in what the parts have run", Action::merge);
  add_folder(merge_app);
  whole(merge_app, "--round", options.round, "That has ended: submit the next one");
  return command;
}

int campaign_command(const CampaignOptions& options, const Folders& folders) {
  using Action = CampaignOptions::Action;
  RobotLibrary library(folders.robots);
  switch (options.action) {
    case Action::run:
      return run(options, library);
    case Action::validate:
      return validate(options, library);
    case Action::resume:
      return resume(options, library);
    case Action::status:
      return status(options, library);
    case Action::report:
      return report(options, library);
    case Action::show:
      return show(options, library);
    case Action::compare:
      return compare(options, library);
    case Action::submit:
      return submit_campaign(options, folders, library);
    case Action::shard:
      return shard_campaign(options, library);
    case Action::merge:
      return merge_campaign(options, library);
  }
  return exit_usage;
}

}  // namespace stagger::server
