// Readers of rates, deadlines, overrun policies and problem size of a cell.
#pragma once

#include <cstdint>

#include "platform/cells/cell.hpp"
#include "platform/cells/toml_reader.hpp"

namespace glint {

[[nodiscard]] inline Duration from_ms(double ms) {
  return {static_cast<std::int64_t>(ms * 1e6 + 0.5)};
}

// A null table keeps the defaults. Requires camera and tools.
void read_rates(const toml::table* table, Cell& cell);
void read_deadlines(const toml::table* table, Cell& cell);  // after the rates
void read_overrun(const toml::table* table, Cell& cell);
void read_budget(const toml::table* table, Cell& cell);

}  // namespace glint
