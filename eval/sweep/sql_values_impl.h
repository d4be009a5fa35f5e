// Names and values as SQLite holds those of a sweep.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <string>
#include <vector>

namespace depthgrid {

// In double quotes, those within doubled: SQL's names, CSV's cells.
std::string Quoted(const std::string& text);

// What is the shortest text of a number goes in as that number, so that SQL and pandas see it as
// such, and comes out as the same text.
void BindYaml(SQLite::Statement& statement, int index, const std::string& text);
std::string YamlOf(const SQLite::Column& column);

// NaN for NULL.
double NumberOf(const SQLite::Column& column);

// The columns of a table without `run`, in its order.
std::vector<std::string> ColumnsOf(SQLite::Database& database, const std::string& table);

}  // namespace depthgrid
