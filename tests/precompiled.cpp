// Nothing: a precompiled header must belong to a target that compiles something.
