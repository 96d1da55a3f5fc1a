#pragma once

#include "gimg/global_parameterization.h"

#include <gtest/gtest.h>

#include <utility>

namespace gimg::test {

inline SurfaceForms formsOf(const Mesh& mesh)
{
    Result<SurfaceForms> forms = surfaceForms(mesh);
    EXPECT_TRUE(forms.ok()) << forms.error().message;
    return std::move(*forms);
}

} // namespace gimg::test
