"""
Sine, cosine, exponential and the like: one implementation, the same bits everywhere.
"""
