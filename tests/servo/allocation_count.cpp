// operator new can be replaced once in a program; this program takes the counter of the reader's tests.
#include "tests/reader/allocation_count.cpp"
