// Two empty functions that an instruction counter finds by their symbols.
#pragma once

extern "C" {
void glint_measure_begin() noexcept;
void glint_measure_end() noexcept;
}
