"""What a user asks of flyby, one file a task: the library behind `import flyby` and the commands.

A task takes options that are stated once (`options`); ``NAME_with`` takes them as one value, NAME
by keywords.
"""
