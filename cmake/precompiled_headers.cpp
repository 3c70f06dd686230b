// Nothing of its own: the headers of understory_precompiled_headers.cmake are compiled beside it.
