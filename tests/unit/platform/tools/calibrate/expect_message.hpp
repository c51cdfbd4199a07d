// Expects an InputError whose message contains all given words.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

#include "platform/input_error.hpp"

namespace glint::test {

template <class Call>
void expect_input_error(const Call& call, std::initializer_list<const char*> words) {
  try {
    call();
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    for (const char* word : words) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos)
          << "'" << word << "' is not in: " << error.what();
    }
  }
}

}  // namespace glint::test
