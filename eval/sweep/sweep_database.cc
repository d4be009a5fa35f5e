#include "eval/sweep/sweep_database.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <filesystem>
#include <limits>
#include <set>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "eval/sweep/sql_errors_impl.h"
#include "eval/sweep/sql_values_impl.h"
#include "mapper/core/error.h"
#include "mapper/io/number_rows.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
// Another program may be using the database, but never for this long.
constexpr int kBusyTimeoutMs = 60'000;
// Version of the tables' layout below.
constexpr const char* kSchema = "1";
// Suffixes of an incomplete database and of SQLite's journal beside it.
constexpr const char* kPartial = ".partial";
constexpr const char* kJournal = "-journal";

constexpr const char* kTables = R"(
CREATE TABLE environment (key TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE runs (run INTEGER PRIMARY KEY, point INTEGER NOT NULL, state TEXT NOT NULL);
CREATE TABLE parameters (run INTEGER PRIMARY KEY);
CREATE TABLE metrics (run INTEGER PRIMARY KEY);
CREATE TABLE times (run INTEGER PRIMARY KEY);
CREATE TABLE failures (run INTEGER PRIMARY KEY, reason TEXT NOT NULL);
)";

std::string DatabasePath(const std::string& folder) {
  return (fs::path(folder) / kSweepDatabaseName).string();
}

// Why the database cannot be written; empty if it can.
std::string RefusalToWrite(const std::string& folder) {
  for (const std::string& path : {folder, DatabasePath(folder)}) {
    if (::access(path.c_str(), W_OK) != 0) return std::generic_category().message(errno);
  }
  return "";
}

void RequireSweep(const std::string& folder) {
  if (SweepDatabase::Exists(folder)) return;
  throw InputError(folder, fmt::format("is no sweep's folder: it has no {}", kSweepDatabaseName));
}

// The path in a URI: percent-encoded except for RFC 3986's unreserved characters and slashes.
std::string UriPath(const fs::path& path) {
  std::string uri;
  for (const char c : path.string()) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                       std::string_view("-._~/").find(c) != std::string_view::npos;
    uri += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return uri;
}

}  // namespace

struct SweepDatabase::Impl {
  std::string folder;
  std::unique_ptr<SQLite::Database> database;
  std::set<std::string> known_columns;  // "table.column"

  Impl(const std::string& of_folder, const std::string& path, int flags)
      : folder(of_folder),
        database(std::make_unique<SQLite::Database>(path, flags, kBusyTimeoutMs)) {}

  // Inserts a row into a table with one column per name; missing columns are added.
  void InsertWide(const std::string& table, int run, const NamedValues& values) {
    std::string names = "run";
    std::string marks = "?";
    for (const auto& [name, value] : values) {
      if (!known_columns.contains(table + "." + name)) AddColumn(table, name);
      names += ", " + Quoted(name);
      marks += ", ?";
    }
    SQLite::Statement insert(*database,
                             fmt::format("INSERT INTO {} ({}) VALUES ({})", table, names, marks));
    insert.bind(1, run);
    int index = 2;
    for (const auto& [name, value] : values) insert.bind(index++, value);  // NaN becomes NULL
    insert.exec();
  }

  std::vector<int> RunsWhere(const std::string& condition) const {
    return Reading(DatabasePath(folder), [&] {
      std::vector<int> runs;
      SQLite::Statement query(*database, "SELECT run FROM runs " + condition + " ORDER BY run");
      while (query.executeStep()) runs.push_back(query.getColumn(0).getInt());
      return runs;
    });
  }

  void AddColumn(const std::string& table, const std::string& name) {
    const auto columns = ColumnsOf(*database, table);
    if (std::find(columns.begin(), columns.end(), name) == columns.end()) {
      database->exec(fmt::format("ALTER TABLE {} ADD COLUMN {} REAL", table, Quoted(name)));
    }
    known_columns.insert(table + "." + name);
  }

  void Insert(const RunOutcome& outcome) {
    const bool failed = !outcome.failure.empty();
    SQLite::Statement state(*database, "UPDATE runs SET state = ? WHERE run = ?");
    state.bind(1, failed ? "failed" : "done");
    state.bind(2, outcome.run);
    Require(state.exec() == 1, "only planned runs have an outcome");
    if (failed) {
      SQLite::Statement reason(*database, "INSERT INTO failures VALUES (?, ?)");
      reason.bind(1, outcome.run);
      reason.bind(2, outcome.failure);
      reason.exec();
    } else {
      InsertWide("metrics", outcome.run, outcome.metrics);
    }
    InsertWide("times", outcome.run, outcome.times);
  }

  void PlanRuns(const std::vector<std::string>& parameter_keys,
                const std::vector<PlannedRun>& plan) {
    std::string marks = "?";
    for (const std::string& key : parameter_keys) {
      database->exec("ALTER TABLE parameters ADD COLUMN " + Quoted(key));
      marks += ", ?";
    }
    SQLite::Statement run(*database, "INSERT INTO runs VALUES (?, ?, 'planned')");
    SQLite::Statement values(*database, "INSERT INTO parameters VALUES (" + marks + ")");
    for (const PlannedRun& planned : plan) {
      Require(planned.values.size() == parameter_keys.size(), "each parameter has a value");
      run.bind(1, planned.run);
      run.bind(2, planned.point);
      run.exec();
      run.reset();
      values.bind(1, planned.run);
      int index = 2;
      for (const std::string& value : planned.values) BindYaml(values, index++, value);
      values.exec();
      values.reset();
    }
  }

  void Note(const std::string& key, const std::string& value) {
    SQLite::Statement insert(*database, "INSERT OR REPLACE INTO environment VALUES (?, ?)");
    insert.bind(1, key);
    insert.bind(2, value);
    insert.exec();
  }

  // Columns of a table of numbers for all finished runs, sorted by name.
  std::vector<SweepColumn> WideColumns(const std::string& table) const {
    std::vector<std::string> names = ColumnsOf(*database, table);
    std::sort(names.begin(), names.end());
    std::vector<SweepColumn> columns;
    for (const std::string& name : names) columns.push_back({name, {}});
    if (columns.empty()) return columns;
    std::string selected;
    for (const std::string& name : names) selected += ", t." + Quoted(name);
    SQLite::Statement query(
        *database, fmt::format("SELECT r.run{} FROM runs r LEFT JOIN {} t ON t.run = r.run "
                               "WHERE r.state <> 'planned' ORDER BY r.run",
                               selected, table));
    while (query.executeStep()) {
      for (std::size_t i = 0; i < columns.size(); ++i) {
        columns[i].values.push_back(NumberOf(query.getColumn(static_cast<int>(i) + 1)));
      }
    }
    return columns;
  }

  std::vector<SweepParameter> Parameters() const {
    std::vector<SweepParameter> parameters;
    std::string selected;
    for (const std::string& key : ColumnsOf(*database, "parameters")) {
      parameters.push_back({key, {}, {}});
      selected += ", p." + Quoted(key);
    }
    SQLite::Statement query(
        *database, fmt::format("SELECT r.run{} FROM runs r JOIN parameters p ON p.run = r.run "
                               "WHERE r.state <> 'planned' ORDER BY r.run",
                               selected));
    while (query.executeStep()) {
      for (std::size_t i = 0; i < parameters.size(); ++i) {
        const std::string text = YamlOf(query.getColumn(static_cast<int>(i) + 1));
        parameters[i].texts.push_back(text);
        parameters[i].numbers.push_back(ParseNumber(text).value_or(kNone));
      }
    }
    return parameters;
  }
};

SweepDatabase::SweepDatabase(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SweepDatabase::SweepDatabase(SweepDatabase&&) noexcept = default;
SweepDatabase& SweepDatabase::operator=(SweepDatabase&&) noexcept = default;
SweepDatabase::~SweepDatabase() = default;

bool SweepDatabase::Exists(const std::string& folder) { return fs::exists(DatabasePath(folder)); }

bool SweepDatabase::IsUnfinished(const std::string& file_name) {
  const std::string partial = std::string(kSweepDatabaseName) + kPartial;
  return file_name == partial || file_name == partial + kJournal;
}

SweepDatabase SweepDatabase::Create(const std::string& folder,
                                    const std::map<std::string, std::string>& environment,
                                    const std::vector<std::string>& parameter_keys,
                                    const std::vector<PlannedRun>& plan,
                                    const std::vector<RunOutcome>& outcomes) {
  // Under another name until it is complete, so that a kill leaves no partial plan.
  const std::string partial = DatabasePath(folder) + kPartial;
  fs::remove(partial);
  fs::remove(partial + kJournal);
  Writing(DatabasePath(folder), [&] {
    Impl impl(folder, partial, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    SQLite::Transaction transaction(*impl.database);
    impl.database->exec(kTables);
    impl.Note("schema", kSchema);
    for (const auto& [key, value] : environment) impl.Note(key, value);
    impl.PlanRuns(parameter_keys, plan);
    for (const RunOutcome& outcome : outcomes) impl.Insert(outcome);
    transaction.commit();
  });
  fs::rename(partial, DatabasePath(folder));
  return Open(folder);
}

SweepDatabase SweepDatabase::Opened(const std::string& folder, const std::string& name, int flags) {
  SweepDatabase opened = Reading(DatabasePath(folder), [&] {
    return SweepDatabase(std::make_unique<Impl>(folder, name, flags));
  });
  const std::string schema = opened.Environment()["schema"];
  if (schema == kSchema) return opened;
  throw InputError(DatabasePath(folder),
                   fmt::format("has layout '{}', must have {}", schema, kSchema));
}

SweepDatabase SweepDatabase::Open(const std::string& folder) {
  RequireSweep(folder);
  if (const std::string why = RefusalToWrite(folder); !why.empty()) {
    throw InputError(DatabasePath(folder), "cannot be written: " + why);
  }
  SweepDatabase opened = Opened(folder, DatabasePath(folder), SQLite::OPEN_READWRITE);
  // A killed program loses nothing in either mode; a write-ahead log commits ten times faster.
  Writing(DatabasePath(folder), [&] {
    opened.impl_->database->exec("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL");
  });
  return opened;
}

SweepDatabase SweepDatabase::OpenToRead(const std::string& folder) {
  RequireSweep(folder);
  // With a write-ahead log even readers write files beside the database.
  if (RefusalToWrite(folder).empty()) return Open(folder);
  std::error_code missing;
  const std::string log = DatabasePath(folder) + "-wal";
  if (const auto size = fs::file_size(log, missing); !missing && size > 0) {
    throw InputError(log,
                     "holds the sweep's last runs, and they cannot be read where nothing may be "
                     "written; copy the folder");
  }
  return Opened(folder, "file:" + UriPath(fs::absolute(DatabasePath(folder))) + "?immutable=1",
                SQLite::OPEN_READONLY | SQLite::OPEN_URI);
}

std::map<std::string, std::string> SweepDatabase::Environment() const {
  return Reading(DatabasePath(impl_->folder), [&] {
    std::map<std::string, std::string> environment;
    SQLite::Statement query(*impl_->database, "SELECT key, value FROM environment");
    while (query.executeStep()) {
      environment[query.getColumn(0).getString()] = query.getColumn(1).getString();
    }
    return environment;
  });
}

void SweepDatabase::Note(const std::string& key, const std::string& value) {
  Writing(DatabasePath(impl_->folder), [&] { impl_->Note(key, value); });
}

std::vector<int> SweepDatabase::FinishedRuns() const {
  return impl_->RunsWhere("WHERE state <> 'planned'");
}

std::vector<int> SweepDatabase::UnfinishedRuns() const {
  return impl_->RunsWhere("WHERE state = 'planned'");
}

std::vector<int> SweepDatabase::PlannedRuns() const { return impl_->RunsWhere(""); }

void SweepDatabase::Record(const RunOutcome& outcome) { Record(std::vector{outcome}); }

void SweepDatabase::Record(const std::vector<RunOutcome>& outcomes) {
  try {
    Writing(DatabasePath(impl_->folder), [&] {
      SQLite::Transaction transaction(*impl_->database, SQLite::TransactionBehavior::IMMEDIATE);
      for (const RunOutcome& outcome : outcomes) impl_->Insert(outcome);
      transaction.commit();
    });
  } catch (...) {  // columns added in the transaction are rolled back as well
    impl_->known_columns.clear();
    throw;
  }
}

int SweepDatabase::PlanFailedAgain() {
  int failed = 0;
  Writing(DatabasePath(impl_->folder), [&] {
    SQLite::Database& database = *impl_->database;
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    database.exec("DELETE FROM times WHERE run IN (SELECT run FROM failures)");
    database.exec("DELETE FROM failures");
    failed = database.exec("UPDATE runs SET state = 'planned' WHERE state = 'failed'");
    transaction.commit();
  });
  return failed;
}

void SweepDatabase::Drop(const std::vector<int>& runs) {
  Writing(DatabasePath(impl_->folder), [&] {
    SQLite::Transaction transaction(*impl_->database, SQLite::TransactionBehavior::IMMEDIATE);
    for (const char* table : {"runs", "parameters", "metrics", "times", "failures"}) {
      SQLite::Statement remove(*impl_->database,
                               fmt::format("DELETE FROM {} WHERE run = ?", table));
      for (const int run : runs) {
        remove.bind(1, run);
        remove.exec();
        remove.reset();
      }
    }
    transaction.commit();
  });
}

std::vector<double> SweepDatabase::MetricOf(const std::string& name,
                                            const std::vector<int>& runs) const {
  return Reading(DatabasePath(impl_->folder), [&] {
    const auto columns = ColumnsOf(*impl_->database, "metrics");
    std::vector<double> values(runs.size(), kNone);
    if (std::find(columns.begin(), columns.end(), name) == columns.end()) return values;
    SQLite::Statement query(*impl_->database,
                            "SELECT " + Quoted(name) + " FROM metrics WHERE run = ?");
    for (std::size_t i = 0; i < runs.size(); ++i) {
      query.bind(1, runs[i]);
      if (query.executeStep()) values[i] = NumberOf(query.getColumn(0));
      query.reset();
    }
    return values;
  });
}

SweepResults SweepDatabase::Results() const {
  return Reading(DatabasePath(impl_->folder), [&] {
    // A consistent view, even while others write.
    const SQLite::Transaction snapshot(*impl_->database);
    SweepResults results;
    results.folder = impl_->folder;
    results.environment = Environment();
    SQLite::Statement planned(*impl_->database, "SELECT count(*) FROM runs");
    if (planned.executeStep()) results.planned_runs = planned.getColumn(0).getInt();
    SQLite::Statement query(*impl_->database,
                            "SELECT r.run, r.point, f.reason FROM runs r LEFT JOIN failures f "
                            "ON f.run = r.run WHERE r.state <> 'planned' ORDER BY r.run");
    while (query.executeStep()) {
      results.runs.push_back(query.getColumn(0).getInt());
      results.points.push_back(query.getColumn(1).getInt());
      results.failures.push_back(query.getColumn(2).getString());
    }
    results.parameters = impl_->Parameters();
    results.metrics = impl_->WideColumns("metrics");
    results.times = impl_->WideColumns("times");
    return results;
  });
}

}  // namespace depthgrid
