// Included first by all that hot_loops is made of. Valgrind knows one of the
// two encodings of a move between registers; the assembler takes the other
// where it is a byte shorter. {load} asks for the one that valgrind knows.
asm(".macro vmovq operands:vararg\n"
    "{load} vmovq \\operands\n"
    ".endm\n");
