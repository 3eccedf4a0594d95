"""What is wrong, or will surprise, in a program that reads well."""
