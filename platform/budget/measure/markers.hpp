// Two empty marker functions that an instruction counter locates by their symbols.
#pragma once

extern "C" {
void glint_measure_begin() noexcept;
void glint_measure_end() noexcept;
}
