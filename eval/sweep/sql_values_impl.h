// Conversion of a sweep's names and values to and from SQLite.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <string>
#include <vector>

namespace depthgrid {

// In double quotes, with those inside doubled: for names in SQL and cells in CSV.
std::string Quoted(const std::string& text);

// If `text` is the shortest form of a number, it is stored as a number, so that SQL and pandas read
// it as one; YamlOf() returns the same text.
void BindYaml(SQLite::Statement& statement, int index, const std::string& text);
std::string YamlOf(const SQLite::Column& column);

// NaN for NULL.
double NumberOf(const SQLite::Column& column);

// The columns of a table without `run`, in its order.
std::vector<std::string> ColumnsOf(SQLite::Database& database, const std::string& table);

}  // namespace depthgrid
