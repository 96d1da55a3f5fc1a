# What every target of the project shares: warnings, sanitizers, and the rule that
# floating-point expressions are never contracted (decoded samples are bit-identical everywhere).
function(gimg_target target)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion
    -ffp-contract=off
    $<$<BOOL:${GIMG_WARNINGS_AS_ERRORS}>:-Werror>)
  if(GIMG_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=address,undefined)
  endif()
endfunction()
